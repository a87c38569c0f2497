// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include "platform/robust_mutex.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/segment_layout.hpp"
#include "transport/layout/trace_layout.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {

constexpr uint32_t process_capacity = 1024;
constexpr uint32_t node_capacity = 4096;
constexpr uint32_t endpoint_capacity = 32768;
constexpr uint32_t topic_capacity = 4096;
constexpr uint32_t topic_bucket_count = 4096;
constexpr uint32_t nothing = UINT32_MAX;  ///< no slot

constexpr size_t name_bytes = 256;  ///< ROS names are at most 255 characters

/// free -> live -> closing -> freeing -> free; closing and freeing only for endpoints (see
/// docs/design/topic_dsm.md, Freeing). From freeing on no reference to its memory may be followed.
/// An endpoint is `closing` until its matches are undone, by its process or by the reaper of that;
/// should they die half way, the reaper goes on, or while the process lives the next sweep. Only
/// then it is `closed`, and any process that has the registry lock may free it; a publisher is
/// `freeing` meanwhile.
enum class SlotState : uint32_t { free, live, closing, closed, freeing };

/// True while references to an endpoint's memory may be followed.
constexpr bool has_memory(SlotState state) {
  return state == SlotState::live || state == SlotState::closing || state == SlotState::closed;
}

/// First member of every table entry.
struct Slot {
  std::atomic<SlotState> state;
  uint32_t next_free;                 ///< while free
  std::atomic<uint32_t> incarnation;  ///< raised at each use
};

/// Lifelines of the `alive` file, after those of the process slots.
constexpr uint32_t receive_thread_line = process_capacity;  ///< + cluster, from 1
constexpr uint32_t configurator_line = receive_thread_line + max_clusters + 1;
constexpr uint32_t lifeline_count = configurator_line + 1;

struct ProcessEntry {
  Slot slot;
  pid_t pid;
  uint32_t cluster;
  int32_t core;      ///< -1 = not placed on a core
  int32_t host_cpu;  ///< -1 = not pinned
  TraceSwitch trace;
  uint64_t charged_bytes;  ///< outside the segment, but counted as SMEM
  char label[84];
  std::atomic<uint32_t> is_ending;  ///< told to end, or noted as dead: its end is no death
  WakeWords wake;
};
static_assert(sizeof(ProcessEntry) == 1216 && offsetof(ProcessEntry, trace) == 28);

struct NodeEntry {
  Slot slot;
  uint32_t process;
  std::atomic<uint32_t> traced;  ///< where only some nodes of its process are
  uint32_t reserved;
  char name[name_bytes];
  char ns[name_bytes];
  char enclave[name_bytes];
};
static_assert(sizeof(NodeEntry) == 792);

/// Written by the endpoint's owner only, read by the tools.
struct EndpointCounters {
  std::atomic<uint64_t> messages;     ///< published or taken
  std::atomic<uint64_t> bytes;        ///< of serialized data
  std::atomic<uint64_t> lost;         ///< subscription: overwritten before taken, or unreadable
  std::atomic<uint64_t> expired;      ///< subscription: older than its lifespan when its turn came
  std::atomic<uint64_t> refused;      ///< publisher: did not fit
  std::atomic<uint64_t> overwritten;  ///< publisher: recycled while a reader still wanted it
};

struct EndpointEntry {
  Slot slot;
  EndpointKind kind;
  EndpointRole role;
  uint8_t ignore_local;
  uint8_t type_hash_version;
  uint32_t process;
  uint32_t node;
  uint32_t cluster;
  std::atomic<uint32_t> next_of_topic;  ///< chain of its topic's bucket: an older one (derived)
  uint32_t previous_of_topic;           ///< (derived)
  uint32_t order;                       ///< younger endpoints have greater ones; it wraps around
  uint64_t topic_hash;
  SegmentRef block;  ///< publisher: topic DSM header; subscription: subscription header
  Gid gid;
  Qos qos;
  uint8_t type_hash[32];
  std::atomic<uint64_t> matched_total;
  std::atomic<uint64_t> matched_current;
  std::atomic<uint64_t> incompatible_total;
  std::atomic<uint32_t> incompatible_policy;
  uint32_t topic_dsm_size;  ///< publisher: fixed size from the topic table; 0 = grows
  std::atomic<uint64_t> incompatible_types;
  std::atomic<int64_t> asserted_ns;  ///< publisher: last assertion of manual liveliness; 0 = never
  std::atomic<uint32_t> dead_publishers;  ///< subscription: died and not yet replaced
  uint32_t reserved;
  EndpointCounters counters;
  char topic[name_bytes];
  char type[name_bytes];
};
static_assert(sizeof(EndpointEntry) == 752 && offsetof(EndpointEntry, topic_hash) == 40);

/// One line of the topic table (ROS-lite2 Fig. 7).
struct TopicEntry {
  uint64_t topic_hash;
  uint32_t topic_id;
  uint32_t topic_dsm_size;
  uint64_t receiver_clusters;  ///< bit c - 1 = cluster c
  char name[name_bytes];
};
static_assert(sizeof(TopicEntry) == 280);

/// A process that ended unasked, without leaving. Its slot may have another process meanwhile.
struct Death {
  pid_t pid;
  uint32_t process;  ///< its slot
  int64_t found_ns;  ///< CLOCK_MONOTONIC: when it was reaped
};
static_assert(sizeof(Death) == 16);

/// Kept for the tools: more than die between two looks of theirs, unless all die at once.
constexpr uint32_t kept_deaths = process_capacity;

/// Used part of a table. The free list is derived state: rebuilt from the slots' states.
struct TableHead {
  std::atomic<uint32_t> high_water;
  uint32_t first_free;
};

/// The platform's shape, fixed at creation.
struct Profile {
  uint32_t clusters;
  uint32_t cores_per_cluster;
  uint64_t smem_bytes;                               ///< of each cluster
  int32_t host_cpu_of_receive_thread[max_clusters];  ///< index cluster - 1; -1 = not pinned
};

struct RegistryHeader {
  SegmentHeader segment;
  Profile profile;
  RobustMutex mutex;
  std::atomic<uint64_t> changes;  ///< raised when the lock is taken and given back: odd between
  std::atomic<uint64_t> graph_generation;
  TableHead processes;
  TableHead nodes;
  TableHead endpoints;
  uint32_t topic_count;
  uint32_t closing_count;                  ///< endpoints closing, closed or freeing (derived)
  std::atomic<uint64_t> clusters_present;  ///< bit c - 1: cluster c has a segment
  std::atomic<uint32_t> removed;           ///< the files are gone: no process can join
  uint32_t needs_repair;                   ///< an owner of the mutex died; not yet repaired
  uint32_t sweep_from;                     ///< endpoint slot that the next sweep looks at first
  uint32_t last_order;                     ///< of endpoints
  TraceControl trace;
  std::atomic<uint64_t> death_count;  ///< raised once the death is written down
  Death deaths[kept_deaths];          ///< at death_count mod kept_deaths the next one
  std::atomic<uint32_t> topic_buckets[topic_bucket_count];
};

constexpr uint64_t align_up(uint64_t x, uint64_t alignment) {
  return (x + alignment - 1) / alignment * alignment;
}

constexpr uint64_t process_table_offset = align_up(sizeof(RegistryHeader), 4096);
constexpr uint64_t node_table_offset =
  align_up(process_table_offset + uint64_t{process_capacity} * sizeof(ProcessEntry), 4096);
constexpr uint64_t endpoint_table_offset =
  align_up(node_table_offset + uint64_t{node_capacity} * sizeof(NodeEntry), 4096);
constexpr uint64_t topic_table_offset =
  align_up(endpoint_table_offset + uint64_t{endpoint_capacity} * sizeof(EndpointEntry), 4096);
constexpr uint64_t registry_bytes =
  align_up(topic_table_offset + uint64_t{topic_capacity} * sizeof(TopicEntry), 4096);

}  // namespace manycore
