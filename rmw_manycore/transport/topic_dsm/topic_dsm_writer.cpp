// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/topic_dsm_writer.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "transport/registry/odd_phase.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {
namespace {

/// Default max_blocking_time of Fast DDS.
constexpr int64_t max_blocking_ns = 100'000'000;

/// A topic DSM of fixed size cannot add descriptors later.
uint64_t initial_descriptor_count(const EndpointEntry & endpoint) {
  if (endpoint.topic_dsm_size == 0) {
    return first_descriptor_count;
  }
  const uint64_t most = std::max<uint64_t>(endpoint.topic_dsm_size / record_alignment, 2);
  return power_of_two_at_least(
    std::min(most, std::max(first_descriptor_count, uint64_t{endpoint.qos.depth} * 2)));
}

}  // namespace

TopicDsmHeader & TopicDsmWriter::create(Registry & registry, uint32_t endpoint_slot) {
  EndpointEntry & endpoint = registry.endpoints()[endpoint_slot];
  Cluster & cluster = registry.clusters().at(endpoint.cluster);
  auto & dsm = cluster.allocate_cleared<TopicDsmHeader>(header_bytes(endpoint.transfer));
  dsm.transfer = static_cast<uint8_t>(endpoint.transfer);
  dsm.endpoint.store(endpoint_slot);
  dsm.incarnation.store(endpoint.slot.incarnation);
  dsm.lifespan_ns = endpoint.qos.lifespan_ns;
  dsm.keep_all = endpoint.qos.history == History::keep_all ? 1 : 0;
  dsm.depth = dsm.keep_all != 0 ? keep_all_capacity : endpoint.qos.depth;
  dsm.transient_local = endpoint.qos.durability == Durability::transient_local ? 1 : 0;
  dsm.role = static_cast<uint8_t>(endpoint.role);
  dsm.process = endpoint.process;
  dsm.gid = endpoint.gid;
  try {
    const uint64_t data_bytes = endpoint.topic_dsm_size == 0
                                  ? first_data_bytes
                                  : align_up(endpoint.topic_dsm_size, record_alignment);
    const uint64_t descriptor_count = initial_descriptor_count(endpoint);
    if (endpoint.topic_dsm_size != 0) {
      cluster.require_message_room(Generation::extent_bytes(data_bytes, descriptor_count));
    }
    Generation::reserve(cluster, dsm.generations[0], data_bytes, descriptor_count);
  } catch (...) {
    cluster.free(cluster.ref_of(&dsm).offset(), header_bytes(dsm));
    throw;
  }
  dsm.magic.store(topic_dsm_magic, std::memory_order_release);
  return dsm;
}

void TopicDsmWriter::open_first_generation(Registry & registry, uint32_t endpoint_slot) {
  const EndpointEntry & endpoint = registry.endpoints()[endpoint_slot];
  const Cluster & cluster = registry.clusters().at(endpoint.cluster);
  GenerationEntry & first = cluster.find<TopicDsmHeader>(endpoint.block.offset())->generations[0];
  if (endpoint.topic_dsm_size != 0) {
    cluster.require_file_system_room(first.extent_bytes());
  }
  Generation::open(cluster, first, 1);
}

TopicDsmWriter::TopicDsmWriter(Registry & registry, Cluster & cluster, EndpointEntry & endpoint)
: registry_(registry),
  cluster_(cluster),
  endpoint_(endpoint),
  dsm_(*cluster.find<TopicDsmHeader>(endpoint.block.offset())),
  readers_(registry, cluster, dsm_, endpoint),
  current_(Generation::view(cluster, dsm_.generations[0])),
  pinned_in_slot_(current_.count, no_record) {}

void TopicDsmWriter::enter() noexcept {
  OddPhase::begin(dsm_.phase);
  readers_.begin_phase(start());
}

void TopicDsmWriter::leave() noexcept { OddPhase::end(dsm_.phase); }

/// True for the last `depth` messages, including the one about to be written. Compares sequence
/// numbers because some record numbers are skipped.
bool TopicDsmWriter::is_among_last(uint32_t depth, const RecordDescriptor & record) const noexcept {
  return record.publication_sequence_number + depth > last_sequence_number_ + 1;
}

/// A reply has one reader: the client that it answers.
Readers TopicDsmWriter::readers_of(const RecordDescriptor & record) const noexcept {
  return endpoint_.role == EndpointRole::reply ? readers_.with_gid(record.correlation.client)
                                               : readers_.all();
}

/// KEEP_LAST readers want the last `depth` messages; a client, of those to it.
bool TopicDsmWriter::wants(
  const Reader & reader, uint64_t number, const RecordDescriptor & record) const noexcept {
  if (reader.seat == nullptr || reader.seat->taken.load(std::memory_order_seq_cst) >= number) {
    return false;
  }
  if (reader.subscription->keep_all != 0) {
    return true;
  }
  if (is_of_replies()) {
    return record.publication_sequence_number + reader.subscription->depth >
           reader.seat->replies.load(std::memory_order_relaxed);
  }
  return is_among_last(reader.subscription->depth, record);
}

bool TopicDsmWriter::is_wanted(uint64_t number, const RecordDescriptor & record) const noexcept {
  const int64_t lifespan = endpoint_.qos.lifespan_ns;
  if (lifespan != infinite_ns && realtime_ns() - record.source_timestamp_ns > lifespan) {
    return false;
  }
  if (dsm_.transient_local != 0 && !is_of_replies() && is_among_last(dsm_.depth, record)) {
    return true;
  }
  for (const Reader & reader : readers_of(record)) {
    if (wants(reader, number, record)) {
      return true;
    }
  }
  return false;
}

/// RELIABLE + KEEP_ALL, and a reliable reader still wants the record: it must not be overwritten.
bool TopicDsmWriter::is_owed(uint64_t number) const noexcept {
  const RecordDescriptor * const record = find_descriptor(number);
  if (
    record == nullptr || dsm_.keep_all == 0 || endpoint_.qos.reliability != Reliability::reliable) {
    return false;
  }
  const Readers readers = readers_of(*record);
  return std::any_of(readers.begin(), readers.end(), [&](const Reader & reader) {
    return reader.reliable && wants(reader, number, *record);
  });
}

/// A record that is in no generation any more is not wanted, and no reader claims it.
RecordDescriptor * TopicDsmWriter::find_descriptor(uint64_t number) const noexcept {
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

TopicDsmWriter::Reclaim TopicDsmWriter::reclaim(uint64_t number, bool force) {
  RecordDescriptor * const record = find_descriptor(number);
  if (record != nullptr && record->number.load(std::memory_order_relaxed) == number) {
    const bool wanted = is_wanted(number, *record);
    if (wanted && !force) {
      return Reclaim::wanted;
    }
    if (wanted) {
      endpoint_.counters.overwritten.fetch_add(1, std::memory_order_relaxed);
    }
    // Dekker with the claim: the reader stores `reading` before it loads `number`. Rebuild the
    // reader list after the store, so that a reader that has just joined is checked as well.
    record->number.store(no_record, std::memory_order_seq_cst);
    if (number >= current_.first) {
      pinned_in_slot_[number & (current_.count - 1)] = number;  // until seen unpinned
    }
    readers_.refresh(start());
    readers_.require_all(endpoint_.topic);
  }
  return readers_.is_pinned(number) ? Reclaim::pinned : Reclaim::freed;
}

/// Frees records early (ROS-lite2 III-B: deleted once all subscribers have deserialized). An empty
/// ring restarts at its beginning, so a stream whose readers keep up reuses the same cache lines.
void TopicDsmWriter::reclaim_free_records() {
  while (!blocks_.empty() && reclaim(blocks_.front().number, false) == Reclaim::freed) {
    blocks_.pop_front();
  }
  if (blocks_.empty()) {
    cursor_ = 0;
  }
}

void TopicDsmWriter::wait_for_progress(uint64_t number) {
  if (blocked_until_ns_ == 0) {
    blocked_until_ns_ = monotonic_ns() + max_blocking_ns;
  }
  if (monotonic_ns() >= blocked_until_ns_) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      ErrorCode::timeout,
      "publish on '" + std::string(endpoint_.topic) +
        "' timed out: RELIABLE + KEEP_ALL, and a subscription has not taken its messages for " +
        std::to_string(max_blocking_ns / 1'000'000) + " ms");
  }
  const uint32_t seen = dsm_.progress.load(std::memory_order_seq_cst);
  dsm_.writer_waits.store(1, std::memory_order_seq_cst);
  // Dekker with a reader that leaves: its row is closed before `writer_waits` is looked at.
  readers_.refresh(start());
  if (is_owed(number)) {
    registry_.tracer().note(TraceKind::blocked, dsm_.endpoint.load(), number);
    leave();  // no other process has to wait for this publisher's phase meanwhile
    futex_wait(dsm_.progress, seen, blocked_until_ns_);
    enter();
  }
  dsm_.writer_waits.store(0, std::memory_order_relaxed);
  readers_.require_all(endpoint_.topic);  // the list is of another phase
}

void TopicDsmWriter::make_place(uint64_t number, uint64_t need_bytes) {
  if (!grow_to_hold_more(need_bytes)) {
    give_up(number);
  }
}

/// Waits for the readers of a record that is owed to them, or overwrites it.
void TopicDsmWriter::give_up(uint64_t number) {
  if (is_owed(number)) {
    wait_for_progress(number);
  } else {
    reclaim(number, true);
  }
}

/// Advances next_number_ to a number whose descriptor may be written. Numbers whose descriptor a
/// reader still has pinned are skipped: readers count losses by publication sequence number, not by
/// record number.
void TopicDsmWriter::claim_descriptor(uint64_t need_bytes) {
  const uint64_t max_skipped = current_.count * (readers_.all().size() + 1);
  for (uint64_t skipped = 0; skipped < max_skipped;) {
    RecordDescriptor & record = current_.descriptor(next_number_);
    const uint64_t old = record.number.load(std::memory_order_relaxed);
    if (old != no_record && &current_.descriptor(old) != &record) {
      // Damaged: no such number belongs here
      record.number.store(no_record, std::memory_order_seq_cst);
      continue;
    }
    if (old != no_record) {
      if (reclaim(old, false) == Reclaim::wanted) {
        make_place(old, need_bytes);
      }
      continue;
    }
    uint64_t & pinned = pinned_in_slot_[next_number_ & (current_.count - 1)];
    if (pinned == no_record || !readers_.is_pinned(pinned)) {
      pinned = no_record;
      return;
    }
    ++next_number_;
    ++skipped;
  }
  endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  throw Error(
    ErrorCode::no_space, "cannot publish on '" + std::string(endpoint_.topic) +
                           "': subscriptions are reading every record of its topic DSM");
}

/// Places a block of `need_bytes` at or after the cursor. False if wanted or pinned records leave
/// no room within one round.
bool TopicDsmWriter::try_place(uint64_t need_bytes) {
  // Each reader may in turn pin the very record that the cursor meets, but it tries to claim a
  // cleared record only once. That bounds the rounds.
  const size_t rounds = readers_.all().size() + 1;
  size_t pinned_seen = 0;
  size_t wraps = 0;
  while (true) {
    const bool ahead = !blocks_.empty() && blocks_.front().begin >= cursor_;
    const uint64_t limit = ahead ? blocks_.front().begin : current_.data_bytes;
    if (limit - cursor_ >= need_bytes) {
      blocks_.push_back({cursor_, cursor_ + need_bytes, next_number_});
      cursor_ += need_bytes;
      return true;
    }
    if (!ahead) {
      if (++wraps > rounds) {
        return false;
      }
      cursor_ = 0;
      continue;
    }
    const Block block = blocks_.front();
    switch (reclaim(block.number, false)) {
      case Reclaim::freed:
        blocks_.pop_front();
        break;
      case Reclaim::pinned:  // a hole: skipped now, met again in the next round
        if (++pinned_seen > blocks_.size() * rounds) {
          return false;
        }
        blocks_.pop_front();
        blocks_.push_back(block);
        cursor_ = block.end;
        break;
      case Reclaim::wanted: {
        const GenerationEntry * const before = current_.entry;
        make_place(block.number, need_bytes);
        wraps = current_.entry == before ? wraps : size_t{0};
        break;
      }
    }
  }
}

/// What each message begins with: memory that is free by now is taken back.
void TopicDsmWriter::prepare() {
  blocked_until_ns_ = 0;
  readers_.require_all(endpoint_.topic);
  if (!old_.empty()) {
    free_old_generations();
  }
  reclaim_free_records();
  free_idle_chunks();
}

TopicDsmWriter::Room TopicDsmWriter::find_room(uint64_t size_bytes) {
  prepare();
  if (goes_to_chunk(size_bytes)) {
    return find_chunk_room(size_bytes);
  }
  const uint64_t need = align_up(std::max<uint64_t>(size_bytes, 1), record_alignment);
  if (demand_.is_known()) {
    shrink(need);
  }
  require_data_bytes(need);
  claim_descriptor(need);
  if (
    !try_place(need) &&
    !(grow(std::max(current_.data_bytes, need) * 2, current_.count) && try_place(need))) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      ErrorCode::no_space,
      "the topic DSM of '" + std::string(endpoint_.topic) +
        "' is full of records that are being read; a message of " + std::to_string(size_bytes) +
        " bytes needs a topic_dsm_size of at least " + std::to_string(current_.data_bytes + need));
  }
  demand_.note(held_records(), blocks_.bytes());
  const Block & block = blocks_.back();
  return {cluster_.find<uint8_t>(current_.data_offset) + block.begin, block.end - block.begin};
}

void TopicDsmWriter::abandon_room() noexcept {
  if (std::exchange(is_chunk_in_work_, false)) {
    chunks_.put_back_newest();
    return;
  }
  cursor_ = blocks_.back().begin;
  blocks_.pop_back();
}

/// Clients count their replies by themselves: each has a sequence of its own.
void TopicDsmWriter::number_reply(RecordDescriptor & record) const noexcept {
  record.publication_sequence_number = 0;
  for (const Reader & client : readers_.with_gid(record.correlation.client)) {
    if (client.seat != nullptr) {
      record.publication_sequence_number = client.seat->replies.load(std::memory_order_relaxed) + 1;
    }
  }
}

/// From here on the reply is published for its client, whose look goes up to `last_reply`.
void TopicDsmWriter::announce_reply(const RecordDescriptor & record) const noexcept {
  for (const Reader & client : readers_.with_gid(record.correlation.client)) {
    if (client.seat != nullptr) {
      client.seat->last_reply.store(next_number_, std::memory_order_release);
      client.seat->replies.store(record.publication_sequence_number, std::memory_order_release);
    }
  }
}

/// Ends the room in the ring with the bytes used. Returns their offset.
uint64_t TopicDsmWriter::commit_block(uint64_t size_bytes) noexcept {
  Block & block = blocks_.back();
  blocks_.shrink_back(block.begin + align_up(std::max<uint64_t>(size_bytes, 1), record_alignment));
  block.number = next_number_;
  cursor_ = block.end;
  return current_.data_offset + block.begin;
}

uint64_t TopicDsmWriter::commit(
  uint64_t size_bytes, int64_t source_timestamp_ns, uint64_t publication_sequence_number,
  const Correlation & correlation) {
  RecordDescriptor & record = current_.descriptor(next_number_);
  const bool is_in_chunk = is_chunk_in_work_;
  record.offset = is_in_chunk ? commit_chunk() : commit_block(size_bytes);
  record.memory.store(
    is_in_chunk ? RecordMemory::chunk : RecordMemory::ring, std::memory_order_relaxed);
  record.size_bytes = static_cast<uint32_t>(size_bytes);
  record.source_timestamp_ns = source_timestamp_ns;
  record.publication_sequence_number = publication_sequence_number;
  record.correlation = correlation;
  if (is_of_replies()) {
    number_reply(record);
  }
  // Release: a reader that loads the number also sees the bytes and the fields above.
  record.number.store(next_number_, std::memory_order_release);
  if (is_of_replies()) {
    announce_reply(record);
  }
  const uint64_t skipped = next_number_ - publication_sequence_number;
  dsm_.skipped_before.store(skipped, std::memory_order_relaxed);
  // Dekker with a late joiner: its row is live before it loads `last`.
  dsm_.last.store(next_number_, std::memory_order_seq_cst);
  dsm_.skipped_after.store(skipped, std::memory_order_release);
  readers_.refresh(start());
  if (!readers_.is_complete()) {
    readers_.serve_without_list(start());
  }
  if (is_in_chunk && has_one_reader()) {
    record.memory.store(RecordMemory::chunk_of_one_reader, std::memory_order_release);
  }
  last_number_ = next_number_;
  last_sequence_number_ = publication_sequence_number;
  return next_number_++;
}

}  // namespace manycore
