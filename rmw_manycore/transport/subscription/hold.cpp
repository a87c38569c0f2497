// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/hold.hpp"

#include <utility>

#include "transport/topic_dsm/chunk_table.hpp"

namespace manycore {
namespace {

/// Takes a word that is free, or of a process that has ended.
std::atomic<uint64_t> * take_word(Registry & registry, ChunkHead & chunk, uint64_t own) noexcept {
  for (std::atomic<uint64_t> & word : chunk.holders) {
    uint64_t holder = word.load(std::memory_order_relaxed);
    if (
      !is_holding(registry, holder) &&
      word.compare_exchange_strong(holder, own, std::memory_order_seq_cst)) {
      return &word;
    }
  }
  return nullptr;
}

bool is_held_beside(Registry & registry, const ChunkHead & chunk, const void * own) noexcept {
  for (const std::atomic<uint64_t> & word : chunk.holders) {
    if (&word != own && is_holding(registry, word.load(std::memory_order_seq_cst))) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// All records that are held, this one included, are in use already: a publisher, which may have
/// half of the SMEM, can reserve another one of this size.
bool Hold::leaves_room(const Cluster & cluster, size_t bytes) noexcept {
  return cluster.used_bytes() + bytes <= cluster.size() / 2;
}

std::optional<Hold> Hold::take(
  const Holder & holder, ChunkHead & chunk, const Bytes & bytes, bool is_for_one_reader,
  const HeldCount & count) noexcept {
  if (!leaves_room(holder.cluster, bytes.size)) {
    return std::nullopt;
  }
  const Slot & process = holder.registry.processes()[holder.process].slot;
  const uint64_t own = endpoint_word(holder.process, process.incarnation.load());
  std::atomic<uint64_t> * const word = take_word(holder.registry, chunk, own);
  if (word == nullptr) {
    return std::nullopt;
  }
  // A reader that has left may still hold the record that another one was owed alone.
  const bool is_sole = is_for_one_reader && !is_held_beside(holder.registry, chunk, word);
  return Hold(holder, *word, bytes, is_sole, count.count_);
}

Hold::Hold(
  const Holder & holder, std::atomic<uint64_t> & word, const Bytes & bytes, bool is_sole,
  std::shared_ptr<std::atomic<uint32_t>> count) noexcept
: registry_(holder.registry),
  cluster_(holder.cluster),
  publisher_(holder.publisher),
  word_(&word),
  own_(word.load(std::memory_order_relaxed)),
  bytes_(bytes),
  is_sole_(is_sole),
  count_(std::move(count)) {
  count_->fetch_add(1, std::memory_order_relaxed);
}

Hold::Hold(Hold && other) noexcept
: registry_(other.registry_),
  cluster_(other.cluster_),
  publisher_(other.publisher_),
  word_(std::exchange(other.word_, nullptr)),
  own_(other.own_),
  bytes_(other.bytes_),
  is_sole_(other.is_sole_),
  count_(std::move(other.count_)),
  side_(other.side_) {}

/// The fence orders it after the reads of the bytes: memory is reused after the process's slot says
/// that it is dead.
bool Hold::is_kept() const noexcept {
  std::atomic_thread_fence(std::memory_order_acquire);
  return is_holding(registry_, own_);
}

/// Dekker with the process that frees the topic DSM of a closed publisher: it stores the row's
/// state before it loads the word.
Hold::~Hold() {
  if (word_ == nullptr || side_.is_inherited()) {
    return;
  }
  count_->fetch_sub(1, std::memory_order_relaxed);
  word_->store(0, std::memory_order_seq_cst);
  if (publisher_.state.load(std::memory_order_seq_cst) != SlotState::live) {
    cluster_.wake_reaper();
  }
}

}  // namespace manycore
