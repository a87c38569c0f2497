// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of TopicDsmWriter: large records in chunks, which readers may hold after their claims
// (docs/design/holds.md).

#include <algorithm>
#include <utility>

#include "transport/topic_dsm/chunk_table.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {
namespace {

/// A chunk is freed when this many records were published without it.
constexpr uint64_t idle_records = 256;
constexpr uint64_t records_between_looks = 16;

/// So that messages whose sizes vary find chunks that fit: an eighth more at most.
uint64_t size_class(uint64_t bytes) {
  const uint64_t step = std::max<uint64_t>(power_of_two_at_least(bytes) / 16, 4096);
  return align_up(bytes, step);
}

}  // namespace

/// The ring of a fixed size is all that its topic has. Replies are counted by their clients, and
/// transferred records have their place in the ring of the receiver.
bool TopicDsmWriter::has_chunks() const noexcept {
  return endpoint_.topic_dsm_size == 0 && endpoint_.role == EndpointRole::topic &&
         endpoint_.transfer == Transfer::dsm;
}

bool TopicDsmWriter::goes_to_chunk(uint64_t size_bytes) const noexcept {
  return size_bytes >= min_chunk_message_bytes && size_bytes <= UINT32_MAX && has_chunks();
}

/// A reader stores its hold before it ends its claim, so holds are looked for after claims.
ChunkPool::State TopicDsmWriter::state_of(const Block & chunk) {
  const Reclaim reclaimed = reclaim(chunk.number, false);
  if (reclaimed == Reclaim::wanted) {
    return ChunkPool::State::wanted;
  }
  const bool is_read =
    reclaimed == Reclaim::pinned || is_held(registry_, *cluster_.find<ChunkHead>(chunk.begin));
  return is_read ? ChunkPool::State::read : ChunkPool::State::unused;
}

void TopicDsmWriter::collect_chunks() {
  chunks_.collect([this](const Block & chunk) { return state_of(chunk); });
}

TopicDsmWriter::Room TopicDsmWriter::room_in(const Block & chunk) const noexcept {
  return {cluster_.find<uint8_t>(chunk.begin) + chunk_data, chunk.end - chunk.begin - chunk_data};
}

TopicDsmWriter::Room TopicDsmWriter::find_chunk_room(uint64_t size_bytes) {
  const Block chunk = find_chunk(size_bytes);
  try {
    use_chunk(chunk);
  } catch (...) {
    chunks_.put_back(chunk);
    throw;
  }
  return room_in(chunk);
}

Block TopicDsmWriter::lend(uint64_t size_bytes) {
  prepare();
  return find_chunk(size_bytes);
}

void TopicDsmWriter::take_back(const Block & chunk) {
  prepare();
  use_chunk(chunk);
}

void TopicDsmWriter::use_chunk(Block chunk) {
  claim_descriptor(record_alignment);
  chunk.number = next_number_;
  chunks_.use(chunk);
  is_chunk_in_work_ = true;
}

Block TopicDsmWriter::find_chunk(uint64_t message_bytes) {
  if (message_bytes > cluster_.size() / 2) {
    refuse_chunk(message_bytes, Error(ErrorCode::too_large, "it is too large"));
  }
  const uint64_t bytes = chunk::bytes_for(message_bytes);
  const uint64_t usual = std::exchange(chunk_bytes_, bytes);
  while (true) {
    collect_chunks();
    if (const std::optional<Block> unused = chunks_.take(bytes)) {
      return *unused;
    }
    try {
      return make_chunk(usual == bytes || usual == 0 ? bytes : size_class(bytes));
    } catch (const Error & error) {
      if (free_unused_chunks()) {
        continue;
      }
      const Block * const oldest = chunks_.oldest_wanted();
      if (oldest == nullptr) {
        refuse_chunk(message_bytes, error);
      }
      give_up(oldest->number);
    }
  }
}

/// Backed without the registry lock: if this process dies, the reaper finds the entry.
Block TopicDsmWriter::make_chunk(uint64_t bytes) {
  if (chunks_.bytes() + bytes > cluster_.size() / 2 + chunk::bytes_for(0)) {
    throw Error(ErrorCode::no_space, "it has half of the SMEM of its cluster already");
  }
  chunks_.make_room();
  ChunkEntry & entry = free_chunk_entry();
  {
    const Registry::Lock lock = lock_to_grow();
    cluster_.require_message_room(bytes);
    chunk::reserve(cluster_, entry, bytes);
  }
  const uint64_t offset = entry.offset.load(std::memory_order_relaxed);
  const Block chunk{offset, offset + bytes, last_number_};
  try {
    cluster_.require_file_system_room(bytes);
    chunk::open(cluster_, entry);
  } catch (const Error &) {
    chunks_.add_unbacked(chunk);
    throw;
  }
  chunks_.add(chunk);
  return *chunks_.take(bytes);
}

ChunkEntry & TopicDsmWriter::free_chunk_entry() {
  if (ChunkEntry * const entry = find_chunk_entry(cluster_, dsm_, 0)) {
    return *entry;
  }
  cluster_.back_ahead();
  const Registry::Lock lock = lock_to_grow();
  const EntryTable<ChunkEntry> table = chunks_of(cluster_, dsm_);
  const uint64_t bytes = table.next_block_bytes();
  return table.grow(cluster_.ref_of(&cluster_.allocate_cleared<ChunkEntry>(bytes)).offset());
}

/// False while another process holds the registry lock, or another thread makes or frees a block.
bool TopicDsmWriter::free_chunk(const Block & chunk) noexcept {
  try {
    std::optional<BlockInHand> hand = BlockInHand::try_make(registry_);
    ChunkEntry * const entry = find_chunk_entry(cluster_, dsm_, chunk.begin);
    if (!hand || entry == nullptr) {
      return false;
    }
    const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
    chunk::take_up(cluster_, *entry, *hand);
    return true;
  } catch (const std::exception &) {
    return false;
  }
}

bool TopicDsmWriter::free_idle_chunk(uint64_t records) noexcept {
  const Block * const idle = chunks_.idle(last_number_, records);
  if (idle == nullptr || !free_chunk(*idle)) {
    return false;
  }
  chunks_.remove(*idle);
  return true;
}

/// False if that leaves no more SMEM than there was before a chunk could not be backed.
bool TopicDsmWriter::free_unused_chunks() noexcept {
  const size_t before = chunks_.unused();
  while (free_idle_chunk(0)) {
  }
  return chunks_.unused() < before;
}

void TopicDsmWriter::refuse_chunk(uint64_t message_bytes, const Error & error) {
  endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  if (message_bytes > cluster_.size() / 2) {
    throw Error(ErrorCode::too_large, message_text(message_bytes) + refusal_text(message_bytes));
  }
  const uint64_t kept = chunks_.kept_bytes();
  const std::string holders =
    kept == 0 ? "" : "subscriptions read or hold " + std::to_string(kept) + " bytes of it, and ";
  throw Error(
    error.code() == ErrorCode::no_space ? ErrorCode::too_large : error.code(),
    message_text(message_bytes) + " needs a larger topic DSM, but " + holders + error.what());
}

/// One at a time, now and then: that takes the registry lock.
void TopicDsmWriter::free_idle_chunks() {
  if (chunks_.bytes() != 0 && next_number_ % records_between_looks == 0) {
    collect_chunks();
    free_idle_chunk(idle_records);
  }
}

/// Returns the offset of the record's bytes.
uint64_t TopicDsmWriter::commit_chunk() noexcept {
  is_chunk_in_work_ = false;
  return chunks_.newest().begin + chunk_data;
}

/// Readers are owed a record only if the list has, or had, them in it: their seats say from which
/// record on. A history is for readers that are to come.
bool TopicDsmWriter::has_one_reader() const noexcept {
  return dsm_.transient_local == 0 && readers_.is_complete() && readers_.all().size() == 1;
}

}  // namespace manycore
