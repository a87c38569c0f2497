// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.hpp"
#include "platform/lifeline.hpp"
#include "platform/shared_memory.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/registry/cluster.hpp"
#include "transport/trace/tracer.hpp"

namespace manycore {

/// A table of slots in the registry. Adding and removing need the registry lock; looking does not.
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

  /// A slot to fill in; it exists for others only after publish(). Throws Error{no_space}.
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
  void rebuild_free_list() const noexcept {
    head_.first_free = 0;
    for (uint32_t slot = 0; slot < high_water(); ++slot) {
      if ((*this)[slot].slot.state.load(std::memory_order_relaxed) == SlotState::free) {
        give_back(slot);
      }
    }
  }

private:
  /// A reader that sees anything of what is filled in from now on sees this incarnation, too.
  void begin_use(uint32_t slot, uint32_t incarnation) const noexcept {
    (*this)[slot].slot.incarnation.store(incarnation, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
  }

  SharedMemory & memory_;
  TableHead & head_;
  uint64_t offset_;
  uint32_t capacity_;
};

/// A cluster is there, but this process cannot map it now: it has no descriptor left, say. Its
/// objects are in use all the same, so nothing that depends on them may be taken for done.
class OutOfReach : public Error {
public:
  using Error::Error;
};

/// One line for the topic table of a new platform.
struct TopicConfiguration {
  std::string name;
  uint32_t id = 0;
  uint32_t dsm_size_bytes = 0;  ///< 0 = grows
  uint64_t receiver_clusters = 0;
};

/// The platform's table of processes, nodes, endpoints and topics. Changed under its robust lock,
/// off the data path.
class Registry {
public:
  static void create(
    const PlatformPaths & paths, const Profile & profile,
    const std::vector<TopicConfiguration> & topics);
  /// Throws Error{corrupt}.
  explicit Registry(const PlatformPaths & paths);

  /// Holds the registry lock while alive.
  class Lock {
  public:
    static constexpr long usual_wait_ns = 5'000'000'000;
    static constexpr long short_wait_ns = 100'000'000;  ///< from inside a publish
    static constexpr long no_wait_ns = 0;
    struct WhileOwnersRun {};

    /// A process that had the lock and comes back at once lets those go first that waited for it,
    /// but for short waits. Throws Error{timeout} when the lock is not to be had within `wait_ns`;
    /// OutOfReach when a former owner died and this process cannot map all that is to be repaired.
    explicit Lock(Registry & registry, long wait_ns = usual_wait_ns);
    /// Waits as usual for owners that run, or wait for a CPU themselves; for one that is stopped,
    /// or not visible here, only `short_wait_ns`.
    Lock(Registry & registry, WhileOwnersRun wait);
    ~Lock();
    Lock(const Lock &) = delete;
    Lock & operator=(const Lock &) = delete;

  private:
    Lock(Registry & registry, RobustMutex::Outcome outcome);

    Registry & registry_;
  };

  /// How long to wait for the lock to take something away, of which a process has many at its end:
  /// short once the lock stayed taken, until it is to be had again.
  long parting_wait_ns() const noexcept;

  RegistryHeader & header() const noexcept { return memory_.at<RegistryHeader>(0); }
  Table<ProcessEntry> & processes() noexcept { return processes_; }
  Table<NodeEntry> & nodes() noexcept { return nodes_; }
  Table<EndpointEntry> & endpoints() noexcept { return endpoints_; }
  Clusters & clusters() noexcept { return clusters_; }
  /// A cluster that is present, or nullptr when there is none or its segment is damaged. Unlike
  /// clusters().find() it throws OutOfReach when the cluster cannot be mapped.
  Cluster * reach(uint32_t cluster);
  /// The object behind a reference, or nullptr when it leads nowhere. Throws OutOfReach.
  template<typename T>
  T * reach(SegmentRef ref) {
    Cluster * const cluster = reach(ref.cluster());
    return cluster == nullptr ? nullptr : cluster->find<T>(ref.offset());
  }
  const Lifelines & lifelines() const noexcept { return lifelines_; }
  /// Records what this process does through this view of the registry.
  Tracer & tracer() noexcept { return tracer_; }
  const PlatformPaths & paths() const noexcept { return paths_; }
  /// True while the platform's directory still holds what is mapped here, and not a later platform
  /// of the same name.
  bool is_current() const noexcept;
  uint64_t nonce() const noexcept { return header().segment.platform_nonce; }

  TopicEntry & topic(uint32_t index) const noexcept {
    return memory_.at<TopicEntry>(topic_table_offset + uint64_t{index} * sizeof(TopicEntry));
  }
  /// Line of the topic table, or nullptr.
  const TopicEntry * find_topic(const std::string & name) const noexcept;

  /// Chains of endpoints by topic, from the youngest to the oldest; the caller holds the lock.
  void link_endpoint(uint32_t slot) noexcept;
  void unlink_endpoint(uint32_t slot) noexcept;
  /// Visits the slots of a topic's bucket, which it may share with other topics. Without the lock,
  /// a change may lead to other buckets, but not out of the table.
  void for_each_of_bucket(const char * topic, const std::function<void(uint32_t)> & visit) const;

  /// Calls `visit(slot, incarnation)` for those that are older than an endpoint that is in its
  /// chain and stays there, in its bucket, which topics may share. Needs no lock. False when
  /// another one left the chain just where the walk stood: some may then be missing.
  bool for_each_older(uint32_t slot, const std::function<void(uint32_t, uint32_t)> & visit) const;

  /// Raises the graph generation and the epochs of processes that watch it.
  void graph_changed() noexcept;

private:
  friend class Lock;
  std::atomic<uint32_t> & bucket_of(uint64_t topic_hash) const noexcept;
  std::atomic<uint32_t> * link_to(uint32_t slot) noexcept;
  std::optional<uint32_t> next_of(uint32_t slot, uint32_t incarnation) const noexcept;
  RobustMutex::Outcome lock_within(long wait_ns);
  RobustMutex::Outcome lock_while_owners_run();
  void let_others_go_first() const noexcept;
  /// Throws OutOfReach before it changes anything.
  void repair();
  void mark_blocks_of(EndpointEntry & entry) noexcept;

  PlatformPaths paths_;
  SharedMemory memory_;
  Lifelines lifelines_;
  Table<ProcessEntry> processes_;
  Table<NodeEntry> nodes_;
  Table<EndpointEntry> endpoints_;
  Clusters clusters_;
  Tracer tracer_;
  std::atomic<bool> stayed_locked_{false};
  std::atomic<int64_t> others_first_until_ns_{0};  ///< CLOCK_MONOTONIC
};

/// FNV-1a; a hash of names that is equal in every process.
uint64_t hash_name(const char * name) noexcept;

/// Copies a name into a fixed field; throws Error{invalid_argument} when it does not fit.
void store_name(char (&field)[name_bytes], const std::string & name, const char * what);

/// The text in a field; in a damaged registry it may fill the field, without a zero at its end.
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
