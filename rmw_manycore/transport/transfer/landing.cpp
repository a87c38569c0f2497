// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/landing.hpp"

namespace manycore {
namespace {

/// Never back: while a mover copies a record, the last subscription may leave, and the next
/// one begin with a later number.
void raise(std::atomic<uint64_t> & highest, uint64_t number) noexcept {
  uint64_t known = highest.load(std::memory_order_relaxed);
  while (known < number &&
         !highest.compare_exchange_weak(known, number, std::memory_order_seq_cst)) {
  }
}

}  // namespace

/// Its sizes are those of the topic DSM, not those in the landing itself.
Landing Landing::of(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  const uint64_t offset =
    table == nullptr ? 0 : table->landings[receiver.id() - 1].load(std::memory_order_seq_cst);
  const uint64_t count = dsm.generations[0].descriptor_count.load(std::memory_order_relaxed);
  const bool is_sound = offset != 0 && count != 0 && (count & (count - 1)) == 0;
  auto * const header =
    is_sound ? receiver.find<LandingHeader>(offset, landing_bytes(dsm)) : nullptr;
  Landing landing;
  if (
    header == nullptr || header->magic.load(std::memory_order_relaxed) != landing_magic ||
    header->endpoint.load(std::memory_order_relaxed) !=
      dsm.endpoint.load(std::memory_order_relaxed) ||
    header->incarnation.load(std::memory_order_relaxed) !=
      dsm.incarnation.load(std::memory_order_relaxed)) {
    return landing;
  }
  landing.header_ = header;
  landing.mark_mask_ = count - 1;
  landing.data_ = reinterpret_cast<uint8_t *>(header->marks() + count);
  landing.data_bytes_ = dsm.generations[0].data_bytes.load(std::memory_order_relaxed);
  return landing;
}

uint8_t * Landing::find(const RecordPlace & place) const noexcept {
  const bool is_inside =
    place.begin <= data_bytes_ && place.size_bytes <= data_bytes_ - place.begin;
  return is_inside ? data_ + place.begin : nullptr;
}

/// Read against the order of the writers: `decided` and `done` are stored last. `decided` once more
/// in the end: a record that was dropped meanwhile is not reported, if another one was under way.
bool Landing::is_settled(uint64_t published, uint64_t known) const noexcept {
  const bool is_decided = header_->decided.load(std::memory_order_seq_cst) >= published;
  const uint64_t handed = header_->handed.load(std::memory_order_seq_cst);
  const bool is_done = header_->done.load(std::memory_order_seq_cst) >= handed;
  return is_decided && is_done && arrived() <= known &&
         header_->decided.load(std::memory_order_seq_cst) == published;
}

/// Release: a reader that finds the mark finds the bytes.
void Landing::arrive(uint64_t number) const noexcept {
  mark_of(number).store(number, std::memory_order_release);
  raise(header_->arrived, number);
  note_done(number);
}

void Landing::give_up(uint64_t number) const noexcept { note_done(number); }

/// Dekker with a publisher that waits: it counts itself before it looks at `done` once more.
void Landing::note_done(uint64_t number) const noexcept {
  raise(header_->done, number);
  if (header_->sender_waits.load(std::memory_order_seq_cst) != 0) {
    header_->progress.fetch_add(1, std::memory_order_seq_cst);
    futex_wake_all(header_->progress);
  }
}

}  // namespace manycore
