// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.hpp"
#include "platform/lifeline.hpp"
#include "platform/shared_memory.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/registry/cluster.hpp"
#include "transport/registry/phases_seen.hpp"
#include "transport/registry/registry_mutex.hpp"
#include "transport/trace/tracer.hpp"

namespace manycore {

/// FNV-1a; equal for equal names in all processes.
uint64_t hash_name(const char * name) noexcept;

/// A table of slots in the registry. take(), publish() and give_back() require the registry lock;
/// reads do not.
template<typename Entry>
class Table {
public:
  Table(SharedMemory & memory, TableHead & head, uint64_t offset, uint32_t capacity) noexcept
  : memory_(memory), head_(head), offset_(offset), capacity_(capacity) {}

  Entry & operator[](uint32_t slot) const noexcept {
    return memory_.at<Entry>(offset_ + uint64_t{slot} * sizeof(Entry));
  }
  uint32_t high_water() const noexcept {
    const uint32_t count = head_.high_water.load(std::memory_order_acquire);
    return count <= capacity_ ? count : capacity_;
  }
  bool is_live(uint32_t slot) const noexcept {
    return slot < high_water() &&
           (*this)[slot].slot.state.load(std::memory_order_acquire) == SlotState::live;
  }

  /// Takes a slot to fill in; other processes see it only after publish(). Throws
  /// Error{no_space|corrupt}.
  uint32_t take(const char * what);
  void publish(uint32_t slot) const noexcept {
    (*this)[slot].slot.state.store(SlotState::live, std::memory_order_release);
  }
  void give_back(uint32_t slot) const noexcept {
    Slot & entry = (*this)[slot].slot;
    entry.state.store(SlotState::free, std::memory_order_release);
    entry.next_free = head_.first_free;
    head_.first_free = slot + 1;
  }
  /// Maps its used part into this process, so that the first access does not fault.
  void populate() const noexcept { memory_.populate(offset_, high_water() * sizeof(Entry)); }
  void rebuild_free_list() const noexcept {
    head_.first_free = 0;
    for (uint32_t slot = 0; slot < high_water(); ++slot) {
      if ((*this)[slot].slot.state.load(std::memory_order_relaxed) == SlotState::free) {
        give_back(slot);
      }
    }
  }

private:
  /// Release fence: a reader that sees any field filled in from now on also sees this incarnation.
  void begin_use(uint32_t slot, uint32_t incarnation) const noexcept {
    (*this)[slot].slot.incarnation.store(incarnation, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
  }

  SharedMemory & memory_;
  TableHead & head_;
  uint64_t offset_;
  uint32_t capacity_;
};

/// The cluster exists, but this process cannot map it at present, for example because it has no
/// file descriptor left. Its objects are in use, so nothing that depends on them may be treated as
/// done.
class ClusterUnmappable : public Error {
public:
  using Error::Error;
};

/// One line of a new platform's topic table.
struct TopicConfiguration {
  std::string name;
  uint32_t id = 0;
  uint32_t dsm_size_bytes = 0;  ///< 0 = grows
  uint64_t receiver_clusters = 0;
  TransferSettings transfer{};
  ZeroCopy zero_copy = ZeroCopy::unset;
};

/// The platform's table of processes, nodes, endpoints and topics. Changed under its robust lock,
/// off the data path.
class Registry {
public:
  static void create(
    const PlatformPaths & paths, const Profile & profile,
    const std::vector<TopicConfiguration> & topics);
  /// Throws Error{corrupt|system} if the file cannot be mapped or is damaged.
  explicit Registry(const PlatformPaths & paths);

  /// Holds the registry lock during its lifetime.
  class Lock {
  public:
    static constexpr long usual_wait_ns = RegistryMutex::usual_wait_ns;
    static constexpr long short_wait_ns = RegistryMutex::short_wait_ns;
    static constexpr long no_wait_ns = RegistryMutex::no_wait_ns;
    struct WhileOwnersRun {};

    /// Throws Error{timeout} if the lock is not available within `wait_ns`. If a former owner died,
    /// waits twice, to find that and to repair, and throws ClusterUnmappable if this process cannot
    /// map all clusters. See RegistryMutex::take().
    explicit Lock(Registry & registry, long wait_ns = usual_wait_ns);
    /// See RegistryMutex::take_while_owners_run().
    Lock(Registry & registry, WhileOwnersRun wait);
    ~Lock();
    Lock(const Lock &) = delete;
    Lock & operator=(const Lock &) = delete;

  private:
    Registry & registry_;
    RegistryMutex::Taken taken_;
  };

  PhasesSeen & phases_seen() noexcept { return phases_seen_; }

  /// Takes the lock as the holder of a line, whose hand is then this process's; see
  /// RegistryMutex::use_badge_of().
  void use_badge_of(uint32_t line) noexcept {
    line_ = line;
    mutex_.use_badge_of(line);
  }
  /// Nullptr in a process that holds no line.
  Hand * own_hand() noexcept { return line_ == nothing ? nullptr : &header().hands[line_]; }
  /// Held by the thread of this process that uses the hand.
  std::mutex & hand_mutex() noexcept { return hand_mutex_; }
  /// Time to wait for the lock when a process removes its many objects at its end: short once the
  /// lock timed out, until it was acquired again.
  long parting_wait_ns() const noexcept { return mutex_.parting_wait_ns(); }

  RegistryHeader & header() const noexcept { return memory_.at<RegistryHeader>(0); }
  Table<ProcessEntry> & processes() noexcept { return processes_; }
  Table<NodeEntry> & nodes() noexcept { return nodes_; }
  Table<EndpointEntry> & endpoints() noexcept { return endpoints_; }
  Clusters & clusters() noexcept { return clusters_; }
  /// A cluster that exists, or nullptr if there is none or its segment is damaged. Unlike
  /// clusters().find(), throws ClusterUnmappable if the cluster cannot be mapped.
  Cluster * map_cluster(uint32_t cluster);
  /// Object behind a reference, or nullptr if the reference is invalid. Throws ClusterUnmappable.
  template<typename T>
  T * map(SegmentRef ref) {
    Cluster * const cluster = map_cluster(ref.cluster());
    return cluster == nullptr ? nullptr : cluster->find<T>(ref.offset());
  }
  const Lifelines & lifelines() const noexcept { return lifelines_; }
  /// Traces the actions of this process on the platform.
  Tracer & tracer() noexcept { return tracer_; }
  const PlatformPaths & paths() const noexcept { return paths_; }
  /// True while the platform's directory holds the files mapped here, not those of a later platform
  /// of the same name.
  bool is_current() const noexcept;
  uint64_t nonce() const noexcept { return header().segment.platform_nonce; }

  TopicEntry & topic(uint32_t index) const noexcept {
    return memory_.at<TopicEntry>(topic_table_offset + uint64_t{index} * sizeof(TopicEntry));
  }
  /// Line of the topic table, or nullptr.
  const TopicEntry * find_topic(const std::string & name) const noexcept;

  /// The chain of a topic's bucket leads from the endpoint that was linked last to the first one.
  /// An endpoint is in it until its memory is unreachable. The caller holds the lock.
  void link_endpoint(uint32_t slot) noexcept;
  void unlink_endpoint(uint32_t slot) noexcept;
  /// Visits the slots in a topic's bucket, which other topics may share. Without the lock, a
  /// concurrent change may lead the walk to other buckets, but not out of the table.
  template<typename Visit>
  void for_each_of_bucket(const char * topic, Visit visit) const {
    uint32_t slot = bucket_of(hash_name(topic)).first.load(std::memory_order_relaxed);
    for (uint32_t i = 0; slot < endpoints_.high_water() && i < endpoint_capacity; ++i) {
      const uint32_t next = endpoints_[slot].next_of_topic.load(std::memory_order_relaxed);
      visit(slot);
      slot = next;
    }
  }

  /// Calls `visit(slot, incarnation)` for each endpoint in the bucket of a topic, from the youngest
  /// on, until it returns false; other topics may share the bucket. Needs no lock. Endpoints that
  /// leave meanwhile may be visited or missed; all others are visited, once
  /// (docs/model/chains.pml).
  void walk_bucket(
    uint64_t topic_hash, const std::function<bool(uint32_t, uint32_t)> & visit) const;

  /// Makes the endpoints of a bucket look at its rows. The caller holds the lock.
  void raise_changes(uint64_t topic_hash) noexcept;
  /// seq_cst: the caller has stored what a process checks that changed a row.
  uint64_t changes_of(uint64_t topic_hash) const noexcept;

  /// Increments the graph generation and wakes the threads that wait for graph changes.
  void graph_changed() noexcept;

private:
  friend class Lock;
  TopicBucket & bucket_of(uint64_t topic_hash) const noexcept;
  std::atomic<uint32_t> * link_to(uint32_t slot) noexcept;
  std::optional<uint32_t> next_of(uint32_t slot, uint32_t incarnation) const noexcept;
  /// Takes the lock by `take`, and repairs what a former owner left incomplete.
  RegistryMutex::Taken lock_whole(const std::function<RegistryMutex::Taken()> & take);
  /// True if a former owner left something incomplete.
  bool begin_changes(bool owner_died) noexcept;
  /// Maps what repair() works on: page faults would take longer than all else that it does. Takes
  /// no lock. Throws ClusterUnmappable.
  void prepare_repair();
  /// Throws ClusterUnmappable before anything is changed.
  void repair();
  void mark_blocks_of(EndpointEntry & entry) noexcept;
  void mark_blocks_in_hands() noexcept;
  void link_all_endpoints();
  void raise_all_changes() noexcept;

  PlatformPaths paths_;
  SharedMemory memory_;
  Lifelines lifelines_;
  Table<ProcessEntry> processes_;
  Table<NodeEntry> nodes_;
  Table<EndpointEntry> endpoints_;
  Clusters clusters_;
  Tracer tracer_;
  RegistryMutex mutex_;
  uint32_t line_ = nothing;
  std::mutex hand_mutex_;
  PhasesSeen phases_seen_;  ///< used under the lock
};

/// Copies a name into a fixed field. Throws Error{invalid_argument} if it is too long.
void store_name(char (&field)[name_bytes], const std::string & name, const char * what);

/// Text of a field. In a damaged registry the terminating NUL may be missing.
template<size_t size>
std::string text_of(const char (&field)[size]) {
  return {field, strnlen(field, size)};
}

template<typename Entry>
uint32_t Table<Entry>::take(const char * what) {
  if (head_.first_free > high_water()) {
    throw Error(
      ErrorCode::corrupt, "the platform's table of " + std::string(what) +
                            " is damaged; stop the nodes, run 'manycore clean'");
  }
  if (head_.first_free != 0) {
    const uint32_t slot = head_.first_free - 1;
    head_.first_free = (*this)[slot].slot.next_free;
    begin_use(slot, (*this)[slot].slot.incarnation.load(std::memory_order_relaxed) + 1);
    return slot;
  }
  const uint32_t slot = head_.high_water.load(std::memory_order_relaxed);
  if (slot >= capacity_) {
    throw Error(
      ErrorCode::no_space, "the platform's table of " + std::string(what) + " is full (" +
                             std::to_string(capacity_) + ")");
  }
  memory_.reserve(offset_ + uint64_t{slot} * sizeof(Entry), sizeof(Entry));
  head_.high_water.store(slot + 1, std::memory_order_release);
  begin_use(slot, 1);
  return slot;
}

}  // namespace manycore
