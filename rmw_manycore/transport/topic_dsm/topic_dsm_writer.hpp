// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/topic_dsm/block_ring.hpp"
#include "transport/topic_dsm/chunk_pool.hpp"
#include "transport/topic_dsm/demand.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_list.hpp"

namespace manycore {

/// Writing side of one topic DSM: finds room, commits records, takes them back. Used by one thread
/// at a time (see Writing). See docs/design/topic_dsm.md, Publish.
class TopicDsmWriter {
public:
  struct Room {
    uint8_t * data = nullptr;
    uint64_t capacity_bytes = 0;
  };

  TopicDsmWriter(Registry & registry, Cluster & cluster, EndpointEntry & endpoint);

  /// Allocates the header and reserves the first generation. The caller holds the registry lock.
  /// Throws Error{no_space|corrupt}.
  static TopicDsmHeader & create(Registry & registry, uint32_t endpoint_slot);
  /// Backs the first generation with memory. Called once, after the endpoint became live and before
  /// its writer is created. Needs no lock: if this process dies, the generation's entry describes
  /// what the reaper must free.
  /// Throws Error{no_space}.
  static void open_first_generation(Registry & registry, uint32_t endpoint_slot);

  /// Makes the phase odd: until leave(), references to readers may be followed. Called by Writing.
  void enter() noexcept;
  void leave() noexcept;

  /// Finds room for one record. Throws Error{too_large|no_space|timeout}.
  Room find_room(uint64_t size_bytes);
  /// False where all records lie in the ring.
  bool has_chunks() const noexcept;
  /// A chunk with room for a message of this size, which belongs to the caller until take_back() or
  /// give_back(). Throws as find_room() does.
  Block lend(uint64_t size_bytes);
  /// Makes a lent chunk the room of the next commit(), in place of find_room(). If it throws, the
  /// chunk stays with the caller.
  void take_back(const Block & chunk);
  void give_back(const Block & chunk) noexcept { chunks_.put_back(chunk); }
  Room room_in(const Block & chunk) const noexcept;
  /// Gives back the room of the last find_room().
  void abandon_room() noexcept;
  /// Publishes the first `size_bytes` of the room as a record and returns its number. The reader
  /// list is up to date afterwards; readers that it lacks for want of memory are set to resync.
  uint64_t commit(
    uint64_t size_bytes, int64_t source_timestamp_ns, uint64_t publication_sequence_number,
    const Correlation & correlation);

  /// Number of the record that the next commit() makes. Valid after find_room().
  uint64_t next_number() const noexcept { return next_number_; }

  const ReaderList & readers() const noexcept { return readers_; }
  TopicDsmHeader & header() const noexcept { return dsm_; }

private:
  enum class Reclaim { freed, pinned, wanted };

  /// Readers that may want a record.
  Readers readers_of(const RecordDescriptor & record) const noexcept;
  bool wants(
    const Reader & reader, uint64_t number, const RecordDescriptor & record) const noexcept;
  bool is_among_last(uint32_t depth, const RecordDescriptor & record) const noexcept;
  bool is_of_replies() const noexcept { return endpoint_.role == EndpointRole::reply; }
  /// Where readers start that are found from now on, until the next commit has ended.
  SeatStart start() const noexcept {
    return {last_number_, is_of_replies() ? 0 : last_sequence_number_};
  }
  void number_reply(RecordDescriptor & record) const noexcept;
  uint64_t commit_block(uint64_t size_bytes) noexcept;
  uint64_t commit_chunk() noexcept;
  void announce_reply(const RecordDescriptor & record) const noexcept;
  bool is_wanted(uint64_t number, const RecordDescriptor & record) const noexcept;
  bool is_owed(uint64_t number) const noexcept;
  RecordDescriptor * find_descriptor(uint64_t number) const noexcept;
  void prepare();
  Reclaim reclaim(uint64_t number, bool force);
  void reclaim_free_records();
  bool drain(Generation & old);
  bool retire(Generation & old);
  void free_old_generations() noexcept;
  /// Throws Error{timeout} if another process holds the registry lock.
  bool free_generation(GenerationEntry & entry);
  void free_unopened(GenerationEntry & entry);
  /// Makes room where a wanted record lies: grows the ring, waits (RELIABLE + KEEP_ALL) or
  /// overwrites.
  void make_place(uint64_t number, uint64_t need_bytes);
  void give_up(uint64_t number);
  void claim_descriptor(uint64_t need_bytes);
  bool try_place(uint64_t need_bytes);
  uint64_t max_descriptors() const noexcept;
  uint64_t deepest_history() const noexcept;
  bool grow_to_hold_more(uint64_t need_bytes);
  bool grow(uint64_t data_bytes, uint64_t descriptor_count);
  /// Like grow(), but throws the cause if the ring cannot grow although its limits allow it:
  /// Error{no_space|corrupt|timeout}.
  bool add_generation(uint64_t data_bytes, uint64_t descriptor_count);
  bool add_generation_for(uint64_t need_bytes);
  /// False if all generation entries are in use. Throws like add_generation().
  bool start_generation(uint64_t data_bytes, uint64_t descriptor_count);
  /// Switches to a smaller generation if a quarter of this one was enough over the last window.
  void shrink(uint64_t need_bytes) noexcept;
  Registry::Lock lock_to_grow();
  void reserve_generation(GenerationEntry & entry, uint64_t data_bytes, uint64_t descriptor_count);
  void open_generation(GenerationEntry & entry);
  void require_data_bytes(uint64_t need_bytes);
  std::string message_text(uint64_t need_bytes) const;
  std::string holders_text() const;
  std::string refusal_text(uint64_t need_bytes) const;
  void wait_for_progress(uint64_t number);
  uint64_t data_limit() const noexcept;
  /// Records with room in the ring, or in a chunk.
  uint64_t held_records() const noexcept { return blocks_.size() + chunks_.in_use(); }
  // In topic_dsm_chunks.cpp:
  bool goes_to_chunk(uint64_t size_bytes) const noexcept;
  Room find_chunk_room(uint64_t size_bytes);
  ChunkPool::State state_of(const Block & chunk);
  void collect_chunks();
  /// If SMEM is short, waits for readers or overwrites records.
  Block find_chunk(uint64_t message_bytes);
  /// The room of the next commit().
  void use_chunk(Block chunk);
  Block make_chunk(uint64_t bytes);
  bool free_chunk(const Block & chunk) noexcept;
  bool free_idle_chunk(uint64_t records) noexcept;
  void free_idle_chunks();
  bool free_unused_chunks() noexcept;
  ChunkEntry & free_chunk_entry();
  [[noreturn]] void refuse_chunk(uint64_t message_bytes, const Error & error);
  bool has_one_reader() const noexcept;

  Registry & registry_;
  Cluster & cluster_;
  EndpointEntry & endpoint_;
  TopicDsmHeader & dsm_;
  ReaderList readers_;
  Generation current_;
  std::vector<Generation> old_;
  BlockRing blocks_;
  ChunkPool chunks_;
  bool is_chunk_in_work_ = false;  ///< the room of the last find_room() is chunks_.newest()
  Demand demand_;
  /// By descriptor: number that a reader may still have pinned, or no_record.
  std::vector<uint64_t> pinned_in_slot_;
  uint64_t chunk_bytes_ = 0;  ///< needed by the last large message
  uint64_t cursor_ = 0;       ///< offset of the next free byte in the data area
  uint64_t next_number_ = 1;
  uint64_t last_number_ = no_record;
  uint64_t last_sequence_number_ = 0;
  int64_t blocked_until_ns_ = 0;
  /// Value of `changes` during a hold of the registry lock that was waited for in vain.
  uint64_t waited_for_ = 0;
};

}  // namespace manycore
