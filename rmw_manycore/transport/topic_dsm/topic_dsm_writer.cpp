// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/topic_dsm_writer.hpp"

#include <algorithm>
#include <utility>

#include "transport/registry/odd_phase.hpp"
#include "transport/transfer/transfer.hpp"
#include "virtual_time/door.hpp"

namespace manycore {
namespace {

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
  if (lifespan != infinite_ns && stamp_now_ns() - record.source_timestamp_ns > lifespan) {
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
