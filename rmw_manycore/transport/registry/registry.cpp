// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/registry.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {
namespace {

uint64_t random_nonce() {
  std::random_device random;
  return uint64_t{random()} << 32 | random();
}

SharedMemory open_registry(const PlatformPaths & paths) {
  // Check the version before the size: a registry of another version may be smaller.
  SharedMemory memory = SharedMemory::open(paths.registry(), sizeof(SegmentHeader));
  check_segment(
    memory.at<SegmentHeader>(0), registry_magic, memory.size(), paths.registry().c_str());
  const std::string damaged =
    paths.registry() + " is damaged; stop the platform's nodes and run 'manycore clean'";
  if (memory.size() < registry_bytes) {
    throw Error(ErrorCode::corrupt, damaged);
  }
  const Profile & profile = memory.at<RegistryHeader>(0).profile;
  if (profile.clusters == 0 || profile.clusters > max_clusters) {
    throw Error(ErrorCode::corrupt, damaged);
  }
  return memory;
}

/// A transferred topic has mirrors of its topic DSM in other clusters, so its size must not change.
void require_fixed_size(const TopicConfiguration & topic) {
  if (topic.transfer.kind != Transfer::dsm && topic.dsm_size_bytes == 0) {
    throw Error(
      ErrorCode::invalid_argument,
      "topic '" + topic.name + "' is transferred: expected a topic_dsm_size, found none");
  }
}

/// Each line of the platform is there, so looking at one never fails.
Lifelines open_lifelines(const PlatformPaths & paths) {
  Lifelines lifelines = Lifelines::open(paths.alive());
  if (lifelines.count() < lifeline_count) {
    throw Error(
      ErrorCode::corrupt,
      paths.alive() + " is damaged; stop the platform's nodes and run 'manycore clean'");
  }
  return lifelines;
}

bool is_gone(const std::string & path) {
  return access(path.c_str(), F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR);
}

}  // namespace

uint64_t hash_name(const char * name) noexcept {
  uint64_t hash = 14695981039346656037u;
  for (; *name != 0; ++name) {
    hash = (hash ^ static_cast<unsigned char>(*name)) * 1099511628211u;
  }
  return hash;
}

void store_name(char (&field)[name_bytes], const std::string & name, const char * what) {
  if (name.size() >= name_bytes) {
    throw Error(
      ErrorCode::invalid_argument, std::string(what) + " '" + name + "' is longer than " +
                                     std::to_string(name_bytes - 1) + " characters");
  }
  std::memset(field, 0, name_bytes);
  std::memcpy(field, name.data(), name.size());
}

void Registry::create(
  const PlatformPaths & paths, const Profile & profile,
  const std::vector<TopicConfiguration> & topics) {
  if (topics.size() > topic_capacity) {
    throw Error(
      ErrorCode::invalid_argument, "the mapfile configures " + std::to_string(topics.size()) +
                                     " topics; the platform's topic table has room for " +
                                     std::to_string(topic_capacity));
  }
  SharedMemory memory = SharedMemory::create(paths.registry(), registry_bytes);
  memory.reserve(0, process_table_offset);
  auto & header = memory.at<RegistryHeader>(0);
  header.segment.version = layout_version;
  header.segment.size_bytes = registry_bytes;
  header.segment.platform_nonce = random_nonce();
  header.profile = profile;
  for (LockBadge & badge : header.badges) {
    badge.held.initialize();
  }
  header.topic_count = static_cast<uint32_t>(topics.size());
  for (uint32_t i = 0; i < topic_bucket_count; ++i) {
    header.topic_buckets[i].first.store(nothing, std::memory_order_relaxed);
  }
  memory.reserve(topic_table_offset, std::max<size_t>(topics.size(), 1) * sizeof(TopicEntry));
  for (size_t i = 0; i < topics.size(); ++i) {
    auto & entry = memory.at<TopicEntry>(topic_table_offset + i * sizeof(TopicEntry));
    store_name(entry.name, topics[i].name, "topic");
    require_fixed_size(topics[i]);
    entry.topic_hash = hash_name(entry.name);
    entry.topic_id = topics[i].id;
    entry.topic_dsm_size = topics[i].dsm_size_bytes;
    entry.receiver_clusters = topics[i].receiver_clusters;
    entry.transfer = topics[i].transfer;
    entry.zero_copy = topics[i].zero_copy;
  }
  header.segment.magic.store(registry_magic, std::memory_order_release);
}

Registry::Registry(const PlatformPaths & paths)
: paths_(paths),
  memory_(open_registry(paths)),
  lifelines_(open_lifelines(paths)),
  processes_(memory_, header().processes, process_table_offset, process_capacity),
  nodes_(memory_, header().nodes, node_table_offset, node_capacity),
  endpoints_(memory_, header().endpoints, endpoint_table_offset, endpoint_capacity),
  clusters_(paths, nonce()),
  tracer_(memory_, paths.directory),
  mutex_(header(), lifelines_, paths.registry()) {}

bool Registry::is_current() const noexcept {
  const uint64_t present = header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    const bool is_needed = (present >> (id - 1) & 1) != 0;
    if (is_needed && (is_gone(paths_.cluster(id)) || is_gone(paths_.pipe(id)))) {
      return false;
    }
  }
  return memory_.is_file(paths_.registry()) && lifelines_.is_file(paths_.alive());
}

Cluster * Registry::map_cluster(uint32_t cluster) {
  const bool is_cluster = cluster != 0 && cluster <= max_clusters;
  if (!is_cluster || (header().clusters_present.load() >> (cluster - 1) & 1) == 0) {
    return nullptr;
  }
  try {
    return &clusters_.at(cluster);
  } catch (const Error & error) {
    if (error.code() == ErrorCode::corrupt) {
      return nullptr;
    }
    throw ClusterUnmappable(
      error.code(),
      "this process cannot map cluster " + std::to_string(cluster) + ": " + error.what());
  }
}

Registry::Lock::Lock(Registry & registry, long wait_ns)
: registry_(registry), taken_(registry.lock_whole([&] { return registry.mutex_.take(wait_ns); })) {}

Registry::Lock::Lock(Registry & registry, WhileOwnersRun)
: registry_(registry),
  taken_(registry.lock_whole([&] { return registry.mutex_.take_while_owners_run(); })) {}

RegistryMutex::Taken Registry::lock_whole(const std::function<RegistryMutex::Taken()> & take) {
  RegistryMutex::Taken taken = take();
  if (!begin_changes(taken.owner_died)) {
    return taken;
  }
  // Until a process has repaired, `changes` stays odd, so graph reads follow no chains.
  mutex_.give_back(taken);
  prepare_repair();
  taken = take();
  if (begin_changes(taken.owner_died)) {
    try {
      repair();
    } catch (...) {
      mutex_.give_back(taken);
      throw;
    }
    header().needs_repair = 0;
  }
  return taken;
}

/// The death is noted at once: only the first thread that takes the lock after it learns of it.
/// Killed before, this thread is the next dead owner.
bool Registry::begin_changes(bool owner_died) noexcept {
  RegistryHeader & head = header();
  head.changes.store(head.changes.load(std::memory_order_relaxed) | 1);
  // Release fence: a reader that sees any of the following changes also sees `changes` odd.
  std::atomic_thread_fence(std::memory_order_release);
  if (owner_died) {
    head.needs_repair = 1;
  }
  return head.needs_repair != 0;
}

Registry::Lock::~Lock() {
  RegistryHeader & header = registry_.header();
  header.changes.store(
    (header.changes.load(std::memory_order_relaxed) | 1) + 1, std::memory_order_release);
  registry_.mutex_.give_back(taken_);
}

const TopicEntry * Registry::find_topic(const std::string & name) const noexcept {
  const uint64_t hash = hash_name(name.c_str());
  for (uint32_t i = 0; i < header().topic_count && i < topic_capacity; ++i) {
    if (topic(i).topic_hash == hash && name == topic(i).name) {
      return &topic(i);
    }
  }
  return nullptr;
}

TopicBucket & Registry::bucket_of(uint64_t topic_hash) const noexcept {
  return header().topic_buckets[topic_hash % topic_bucket_count];
}

void Registry::raise_all_changes() noexcept {
  for (TopicBucket & bucket : header().topic_buckets) {
    bucket.changes.fetch_add(1, std::memory_order_seq_cst);
  }
}

void Registry::raise_changes(uint64_t topic_hash) noexcept {
  bucket_of(topic_hash).changes.fetch_add(1, std::memory_order_seq_cst);
}

uint64_t Registry::changes_of(uint64_t topic_hash) const noexcept {
  return bucket_of(topic_hash).changes.load(std::memory_order_seq_cst);
}

// The lock excludes concurrent changes of chains. Graph reads without the lock check afterwards
// whether a change interfered. The order of loads and stores therefore matters only to
// walk_bucket().
constexpr auto chained = std::memory_order_relaxed;

/// At each instruction a chain holds its old or its new content. If this process dies in between,
/// only `previous_of_topic` and what repair() rebuilds may be wrong.
void Registry::link_endpoint(uint32_t slot) noexcept {
  EndpointEntry & entry = endpoints_[slot];
  std::atomic<uint32_t> & bucket = bucket_of(entry.topic_hash).first;
  const uint32_t next = bucket.load(chained);
  entry.previous_of_topic = nothing;
  // Release: a walk that loads the link also sees the slot's new incarnation.
  entry.next_of_topic.store(next, std::memory_order_release);
  if (next < endpoints_.high_water()) {
    endpoints_[next].previous_of_topic = slot;
  }
  // Release: a walk that begins at the bucket likewise.
  bucket.store(slot, std::memory_order_release);
}

/// The link that leads to an endpoint in its chain. Searches the chain if `previous_of_topic` is
/// damaged.
std::atomic<uint32_t> * Registry::link_to(uint32_t slot) noexcept {
  EndpointEntry & entry = endpoints_[slot];
  std::atomic<uint32_t> * link = &bucket_of(entry.topic_hash).first;
  if (entry.previous_of_topic < endpoints_.high_water()) {
    std::atomic<uint32_t> & next = endpoints_[entry.previous_of_topic].next_of_topic;
    if (next.load(chained) == slot) {
      return &next;
    }
  }
  uint32_t linked = link->load(chained);
  // Bounded: a damaged chain never leads out of the table or into an endless loop.
  for (uint32_t i = 0; linked != slot && linked < endpoints_.high_water() && i < endpoint_capacity;
       ++i) {
    link = &endpoints_[linked].next_of_topic;
    linked = link->load(chained);
  }
  return linked == slot ? link : nullptr;
}

void Registry::unlink_endpoint(uint32_t slot) noexcept {
  EndpointEntry & entry = endpoints_[slot];
  std::atomic<uint32_t> * const link = link_to(slot);
  if (link == nullptr) {
    return;
  }
  const uint32_t next = entry.next_of_topic.load(chained);
  // Release: a walk that follows it also sees the incarnation of the slot that it leads to.
  link->store(next, std::memory_order_release);
  if (next < endpoints_.high_water()) {
    endpoints_[next].previous_of_topic = entry.previous_of_topic;
  }
}

/// Next endpoint of the chain, provided that this one was still in it after the link was loaded
/// (docs/model/chains.pml).
std::optional<uint32_t> Registry::next_of(uint32_t slot, uint32_t incarnation) const noexcept {
  const EndpointEntry & entry = endpoints_[slot];
  const uint32_t next = entry.next_of_topic.load(std::memory_order_acquire);
  const bool was_in_it = is_linked(entry.slot.state.load(std::memory_order_acquire)) &&
                         entry.slot.incarnation.load() == incarnation;
  return was_in_it ? std::optional(next) : std::nullopt;
}

/// If the current endpoint has left the chain, the walk goes back to the last endpoint of its path
/// that has not left: all older endpoints still follow that one. An empty path stands for the
/// bucket.
void Registry::walk_bucket(
  uint64_t topic_hash, const std::function<bool(uint32_t, uint32_t)> & visit) const {
  struct Place {
    uint32_t slot;
    uint32_t incarnation;
  };
  std::vector<Place> path;
  const auto next_of_path = [&] {
    return path.empty() ? std::optional(bucket_of(topic_hash).first.load(std::memory_order_acquire))
                        : next_of(path.back().slot, path.back().incarnation);
  };
  // The limit ends the walk in a damaged chain, which may have a cycle.
  for (uint32_t i = 0; i < 4 * endpoint_capacity; ++i) {
    const std::optional<uint32_t> next = next_of_path();
    if (!next) {
      path.pop_back();
      continue;
    }
    if (*next >= endpoints_.high_water()) {
      return;
    }
    const uint32_t incarnation = endpoints_[*next].slot.incarnation.load();
    if (next_of_path() != next) {
      continue;  // the next endpoint may have left, and its slot may be in another chain
    }
    path.push_back({*next, incarnation});
    if (!visit(*next, incarnation)) {
      return;
    }
  }
}

/// Looks at the processes that have watched the graph, not at all processes: most never do. See
/// Waiters::watch_graph() for the order.
void Registry::graph_changed() noexcept {
  header().graph_generation.fetch_add(1, std::memory_order_seq_cst);
  header().graph_watchers.for_each([this](uint32_t slot) {
    if (processes_.is_live(slot)) {
      processes_[slot].wake.notify_graph();
    }
  });
}

}  // namespace manycore
