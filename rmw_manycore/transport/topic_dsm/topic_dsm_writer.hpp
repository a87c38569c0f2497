// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/topic_dsm/block_ring.hpp"
#include "transport/topic_dsm/demand.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_list.hpp"

namespace manycore {

/// The writing side of one topic DSM: finds room, makes records, takes them back. One thread at a
/// time (see Writing). See docs/design/topic_dsm.md, Publish.
class TopicDsmWriter {
public:
  struct Room {
    uint8_t * data = nullptr;
    uint64_t capacity_bytes = 0;
  };

  TopicDsmWriter(Registry & registry, Cluster & cluster, EndpointEntry & endpoint);

  /// Allocates header and first generation; the caller holds the registry lock.
  static TopicDsmHeader & create(Registry & registry, uint32_t endpoint_slot);

  /// From here to leave(), references to readers may be followed: for Writing.
  void enter() noexcept;
  void leave() noexcept;

  /// Room for one record. Throws Error{too_large|no_space|timeout}.
  Room find_room(uint64_t size_bytes);
  /// Gives the room of the last find_room() back.
  void abandon_room() noexcept;
  /// Makes the room's first `size_bytes` record; returns its number. Readers are up to date
  /// afterwards.
  uint64_t commit(
    uint64_t size_bytes, int64_t source_timestamp_ns, uint64_t publication_sequence_number,
    const Correlation & correlation);

  /// Of the record that commit() makes, after find_room().
  uint64_t next_number() const noexcept { return next_number_; }

  const ReaderList & readers() const noexcept { return readers_; }
  TopicDsmHeader & header() const noexcept { return dsm_; }

private:
  enum class TakeBack { freed, pinned, wanted };

  bool wants(
    const Reader & reader, uint64_t number, const RecordDescriptor & record) const noexcept;
  bool is_among_last(uint32_t depth, const RecordDescriptor & record) const noexcept;
  bool is_wanted(uint64_t number, const RecordDescriptor & record) const noexcept;
  bool is_owed(uint64_t number) const noexcept;
  TakeBack take_back(uint64_t number, bool force);
  void take_back_free_records();
  bool drain(Generation & old);
  bool retire(Generation & old);
  void free_old_generations() noexcept;
  void free_unopened(GenerationEntry & entry);
  /// Makes place where a wanted record stands: grows, waits (RELIABLE + KEEP_ALL) or overwrites.
  void make_place(uint64_t number, uint64_t need_bytes);
  void claim_descriptor(uint64_t need_bytes);
  bool try_place(uint64_t need_bytes);
  uint64_t most_descriptors() const noexcept;
  uint64_t deepest_history() const noexcept;
  bool grow_to_hold_more(uint64_t need_bytes);
  bool grow(uint64_t data_bytes, uint64_t descriptor_count);
  /// As grow(), but throws what keeps it from growing as far as it may:
  /// Error{no_space|corrupt|timeout}.
  bool add_generation(uint64_t data_bytes, uint64_t descriptor_count);
  bool add_generation_for(uint64_t need_bytes);
  /// False when all entries are in use. Throws as add_generation().
  bool start_generation(uint64_t data_bytes, uint64_t descriptor_count);
  /// Goes over to a smaller generation when a quarter of this one was enough for long.
  void shrink(uint64_t need_bytes) noexcept;
  Registry::Lock lock_to_grow();
  void reserve_generation(GenerationEntry & entry, uint64_t data_bytes, uint64_t descriptor_count);
  void open_generation(GenerationEntry & entry);
  void require_data_bytes(uint64_t need_bytes);
  void wait_for_progress(uint64_t number);
  uint64_t data_limit() const noexcept;

  Registry & registry_;
  Cluster & cluster_;
  EndpointEntry & endpoint_;
  TopicDsmHeader & dsm_;
  ReaderList readers_;
  Generation current_;
  std::vector<Generation> old_;
  BlockRing blocks_;
  Demand demand_;
  std::vector<uint64_t>
    pinned_in_slot_;     ///< by descriptor: number that a reader may still hold, or 0
  uint64_t cursor_ = 0;  ///< next free byte of the data area
  uint64_t next_number_ = 1;
  uint64_t last_sequence_number_ = 0;
  int64_t blocked_until_ns_ = 0;
  uint64_t waited_for_ = 0;  ///< in vain: `changes` of the hold of the registry lock
};

}  // namespace manycore
