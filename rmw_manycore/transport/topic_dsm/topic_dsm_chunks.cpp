// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of TopicDsmWriter: large records in chunks, which readers may hold after their claims
// (docs/design/holds.md).

#include <algorithm>
#include <utility>

#include "transport/topic_dsm/chunk_table.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {
namespace {

/// A chunk that was not used for so many records is freed.
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

/// A record that is in no generation any more is not wanted, and no reader claims it.
RecordDescriptor * TopicDsmWriter::find_descriptor(uint64_t number) noexcept {
  if (number >= current_.first) {
    return &current_.descriptor(number);
  }
  for (const Generation & old : old_) {
    if (old.first <= number && number < old.end) {
      return &old.descriptor(number);
    }
  }
  return nullptr;
}

/// As reclaim(), and then looks whether it is held: a reader stores its hold before it ends its
/// claim.
ChunkPool::State TopicDsmWriter::state_of(const Block & chunk) {
  RecordDescriptor * const record = find_descriptor(chunk.number);
  if (record != nullptr && record->number.load(std::memory_order_relaxed) == chunk.number) {
    if (is_wanted(chunk.number, *record)) {
      return ChunkPool::State::wanted;
    }
    record->number.store(no_record, std::memory_order_seq_cst);
    if (chunk.number >= current_.first) {
      pinned_in_slot_[chunk.number & (current_.count - 1)] = chunk.number;
    }
    readers_.refresh(start());
    readers_.require_all(endpoint_.topic);
  }
  const bool is_read =
    readers_.is_pinned(chunk.number) || is_held(registry_, *cluster_.find<ChunkHead>(chunk.begin));
  return is_read ? ChunkPool::State::read : ChunkPool::State::unused;
}

TopicDsmWriter::Room TopicDsmWriter::room_in(const Block & chunk) const noexcept {
  return {cluster_.find<uint8_t>(chunk.begin) + chunk_data, chunk.end - chunk.begin - chunk_data};
}

TopicDsmWriter::Room TopicDsmWriter::find_chunk_room(uint64_t size_bytes) {
  const Block chunk = lend(size_bytes);
  try {
    take_back(chunk);
  } catch (...) {
    chunks_.put_back(chunk);
    throw;
  }
  return room_in(chunk);
}

Block TopicDsmWriter::lend(uint64_t size_bytes) {
  blocked_until_ns_ = 0;
  readers_.require_all(endpoint_.topic);
  chunks_.collect([this](const Block & chunk) { return state_of(chunk); });
  return get_chunk(size_bytes, chunk::bytes_for(size_bytes));
}

void TopicDsmWriter::take_back(Block chunk) {
  readers_.require_all(endpoint_.topic);
  claim_descriptor(record_alignment);
  chunk.number = next_number_;
  chunks_.use(chunk);
  is_chunk_in_work_ = true;
}

Block TopicDsmWriter::get_chunk(uint64_t message_bytes, uint64_t bytes) {
  if (message_bytes > cluster_.size() / 2) {
    refuse_chunk(message_bytes, Error(ErrorCode::too_large, "it is too large"));
  }
  const uint64_t usual = std::exchange(chunk_bytes_, bytes);
  while (true) {
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
      give_up_record(oldest->number);
    }
    chunks_.collect([this](const Block & chunk) { return state_of(chunk); });
  }
}

/// For want of SMEM: waits for the readers of a record that is owed to them, or overwrites it.
void TopicDsmWriter::give_up_record(uint64_t number) {
  if (is_owed(number)) {
    wait_for_progress(number);
    return;
  }
  RecordDescriptor & record = *find_descriptor(number);
  endpoint_.counters.overwritten.fetch_add(1, std::memory_order_relaxed);
  record.number.store(no_record, std::memory_order_seq_cst);
  if (number >= current_.first) {
    pinned_in_slot_[number & (current_.count - 1)] = number;
  }
  readers_.refresh(start());
  readers_.require_all(endpoint_.topic);
}

/// Backed without the registry lock: if this process dies, the reaper finds the entry.
Block TopicDsmWriter::make_chunk(uint64_t bytes) {
  if (chunks_.bytes() + bytes > cluster_.size() / 2 + chunk::bytes_for(0)) {
    throw Error(ErrorCode::no_space, "it has half of the SMEM of its cluster already");
  }
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
    chunks_.add(chunk);
  } catch (...) {
    free_chunk(chunk);
    throw;
  }
  return *chunks_.take(bytes);
}

ChunkEntry & TopicDsmWriter::free_chunk_entry() {
  if (ChunkEntry * const entry = manycore::find_chunk(cluster_, dsm_, 0)) {
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
    ChunkEntry * const entry = manycore::find_chunk(cluster_, dsm_, chunk.begin);
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
  const std::optional<Block> idle = chunks_.take_idle(last_number_, records);
  if (!idle) {
    return false;
  }
  if (!free_chunk(*idle)) {
    chunks_.put_back(*idle);
    return false;
  }
  chunks_.forget(*idle);
  return true;
}

bool TopicDsmWriter::free_unused_chunks() noexcept {
  bool is_any_freed = false;
  while (free_idle_chunk(0)) {
    is_any_freed = true;
  }
  return is_any_freed;
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
    chunks_.collect([this](const Block & chunk) { return state_of(chunk); });
    free_idle_chunk(idle_records);
  }
}

/// Returns the offset of the record's bytes.
uint64_t TopicDsmWriter::use_chunk() noexcept {
  is_chunk_in_work_ = false;
  return chunks_.newest().begin + chunk_data;
}

/// Readers are owed a record only if the list has, or had, them in it: their seats say from which
/// record on. A history is for readers that are to come.
bool TopicDsmWriter::has_one_reader() const noexcept {
  return dsm_.transient_local == 0 && readers_.is_complete() && readers_.all().size() == 1;
}

}  // namespace manycore
