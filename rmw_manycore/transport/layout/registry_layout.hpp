// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include "platform/recoverable_mutex.hpp"
#include "transport/layout/chunk_layout.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/segment_layout.hpp"
#include "transport/layout/slot_set.hpp"
#include "transport/layout/trace_layout.hpp"
#include "transport/layout/transfer_layout.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {

constexpr uint32_t process_capacity = 1024;
constexpr uint32_t node_capacity = 4096;
constexpr uint32_t endpoint_capacity = 32768;
constexpr uint32_t topic_capacity = 4096;
constexpr uint32_t topic_bucket_count = 4096;
constexpr uint32_t nothing = UINT32_MAX;  ///< no slot

constexpr size_t name_bytes = 256;  ///< ROS names are at most 255 characters

/// free -> live -> closed -> freeing -> unreachable -> free; only endpoints pass through the states
/// from closed on (see docs/design/rows_seats_hands.md).
///
/// Any process that holds the registry lock may free a `closed` endpoint. A publisher stays closed
/// while it owes a reader messages, and then becomes `freeing`: from then on no process may follow
/// a reference to its memory. An endpoint becomes `unreachable` once no process can still be
/// following one. Its memory is then freed piece by piece.
enum class SlotState : uint32_t { free, live, closed, freeing, unreachable };

/// True while an endpoint's memory may be freed or is being freed.
constexpr bool is_closed(SlotState state) {
  return state == SlotState::closed || state == SlotState::freeing ||
         state == SlotState::unreachable;
}

/// True while references to a publisher's memory may be followed.
constexpr bool has_memory(SlotState state) {
  return state == SlotState::live || state == SlotState::closed;
}

/// True while an endpoint is in the chain of its topic's bucket.
constexpr bool is_linked(SlotState state) {
  return has_memory(state) || state == SlotState::freeing;
}

/// First member of each table entry.
struct Slot {
  std::atomic<SlotState> state;
  uint32_t next_free;                 ///< valid in state `free`
  std::atomic<uint32_t> incarnation;  ///< incremented each time the slot is taken
};

/// Line numbers of the `alive` file; the process slots come first.
constexpr uint32_t receive_thread_line = process_capacity;  ///< + cluster number, from 1
constexpr uint32_t configurator_line = receive_thread_line + max_clusters + 1;
constexpr uint32_t lifeline_count = configurator_line + 1;

/// Badges with which the registry lock is taken: one for the holder of each line, and one for
/// guests, one at a time: processes that are joining, and tools.
constexpr uint32_t guest_badge = lifeline_count;
constexpr uint32_t lock_badge_count = guest_badge + 1;

/// A member process of the platform.
struct ProcessEntry {
  Slot slot;
  pid_t pid;
  uint32_t cluster;
  int32_t core;      ///< -1 = not placed on a core
  int32_t host_cpu;  ///< -1 = not pinned
  TraceSwitch trace;
  uint64_t charged_bytes;  ///< memory outside the segment that counts as SMEM of the cluster
  char label[84];
  /// Its contexts have ended, or its death is recorded: its end is not recorded as a death.
  std::atomic<uint32_t> is_ending;
  WakeWords wake;
};
static_assert(sizeof(ProcessEntry) == 1280 && offsetof(ProcessEntry, trace) == 28);

/// A ROS 2 node of a member process.
struct NodeEntry {
  Slot slot;
  std::atomic<uint32_t> process;  ///< slot
  std::atomic<uint32_t> traced;   ///< traced, in TraceScope::some_nodes
  uint32_t reserved;
  char name[name_bytes];
  char ns[name_bytes];
  char enclave[name_bytes];
};
static_assert(sizeof(NodeEntry) == 792);

/// Written only by the endpoint's owner; read by the tools.
struct EndpointCounters {
  std::atomic<uint64_t> messages;  ///< published or taken
  std::atomic<uint64_t> bytes;     ///< size of serialized data
  /// Subscription: messages overwritten before they were taken, or unreadable.
  std::atomic<uint64_t> lost;
  /// Subscription that keeps the newest message only: messages not taken, of whose publisher it
  /// found a newer one instead.
  std::atomic<uint64_t> superseded;
  /// Subscription: messages past their lifespan when they were about to be taken.
  std::atomic<uint64_t> expired;
  std::atomic<uint64_t> refused;  ///< publisher: messages that did not fit
  /// Publisher: records recycled while a reader still wanted them.
  std::atomic<uint64_t> overwritten;
  std::atomic<uint64_t> dropped;  ///< publisher: records that did not reach a cluster
  /// Messages written (publisher) or read (subscription) where their record lies, without a copy.
  std::atomic<uint64_t> in_place;
};

/// A publisher or subscription.
struct EndpointEntry {
  Slot slot;
  EndpointKind kind;
  EndpointRole role;
  uint8_t ignore_local;
  uint8_t type_hash_version;
  std::atomic<uint32_t> process;  ///< slot
  uint32_t node;
  uint32_t cluster;
  std::atomic<uint32_t> next_of_topic;  ///< next older endpoint of the topic's bucket (derived)
  uint32_t previous_of_topic;           ///< (derived)
  uint32_t order;  ///< larger the later it was linked into its chain; wraps around
  uint64_t topic_hash;
  SegmentRef block;  ///< publisher: topic DSM header; subscription: subscription header
  Gid gid;
  Qos qos;
  uint8_t type_hash[32];
  uint32_t topic_dsm_size;  ///< publisher: fixed size from the topic table in bytes; 0 = grows
  uint32_t closed_order;    ///< larger the later it was closed; wraps around
  /// Publisher: last assertion of manual liveliness, CLOCK_MONOTONIC; 0 = never.
  std::atomic<int64_t> asserted_ns;
  Transfer transfer;  ///< of the topic, from the topic table
  /// Its process was killed. Stored before the slot ceases to be live.
  std::atomic<uint8_t> died;
  ZeroCopy zero_copy;  ///< of the topic, from the topic table
  uint8_t reserved[5];
  EndpointCounters counters;
  char topic[name_bytes];
  char type[name_bytes];
};
static_assert(
  sizeof(EndpointEntry) == 744 && offsetof(EndpointEntry, topic_hash) == 40 &&
  offsetof(EndpointEntry, counters) == 160);

/// One line of the topic table (ROS-lite2 Fig. 7).
struct TopicEntry {
  uint64_t topic_hash;
  uint32_t topic_id;
  uint32_t topic_dsm_size;
  uint64_t receiver_clusters;  ///< bit c - 1 = cluster c
  TransferSettings transfer;
  ZeroCopy zero_copy;
  uint8_t reserved[7];
  char name[name_bytes];
};
static_assert(sizeof(TopicEntry) == 296);

/// A process that ended without leaving the platform. Its slot may belong to another process by
/// now.
struct Death {
  pid_t pid;
  uint32_t process;  ///< slot it had
  int64_t found_ns;  ///< CLOCK_MONOTONIC: when it was reaped
};
static_assert(sizeof(Death) == 16);

/// Deaths kept for the tools. As many as there are process slots, so a tool misses none between two
/// looks unless more processes than that die in between.
constexpr uint32_t kept_deaths = process_capacity;

/// State of a table. The free list is derived: it is rebuilt from the states of the slots.
struct TableHead {
  std::atomic<uint32_t> high_water;
  uint32_t first_free;
};

/// Shape of the platform, fixed at creation.
struct Profile {
  uint32_t clusters;
  uint32_t cores_per_cluster;
  uint64_t smem_bytes;                               ///< of each cluster
  int32_t host_cpu_of_receive_thread[max_clusters];  ///< index cluster - 1; -1 = not pinned
  int32_t priority_of_receive_thread[max_clusters];  ///< SCHED_FIFO; 0 = SCHED_OTHER
  int32_t numa_node[max_clusters];                   ///< of its SMEM; -1 = any
};

/// SMEM that no endpoint leads to, as it is being reserved for one or given back. The holder of a
/// line has one, written under the registry lock; the reaper of a dead holder frees what is in it.
struct Hand {
  std::atomic<uint64_t> block;  ///< SegmentRef; null = empty; stored last
  std::atomic<uint64_t> bytes;
};
static_assert(sizeof(Hand) == 16);

/// The endpoints of the topics whose names have one hash value modulo the number of buckets.
struct TopicBucket {
  /// Raised under the registry lock after each change of one of their rows, and in all buckets by a
  /// repair. A process that finds it moved looks at the rows (docs/model/freeing.pml).
  std::atomic<uint64_t> changes;
  std::atomic<uint32_t> first;  ///< the youngest one (derived); see EndpointEntry::next_of_topic
  uint32_t reserved;
};
static_assert(sizeof(TopicBucket) == 16);

using GraphWatchers = SlotSet<process_capacity>;
static_assert(sizeof(GraphWatchers) == 128);
using ClosingEndpoints = SlotSet<endpoint_capacity>;
static_assert(sizeof(ClosingEndpoints) == 4096);

/// Head of the registry; its tables follow at the offsets below.
struct RegistryHeader {
  SegmentHeader segment;
  Profile profile;
  RecoverableMutex mutex;
  /// Incremented when the mutex is taken and when it is released: odd while it is held, and from an
  /// owner's death to the end of the repair.
  std::atomic<uint64_t> changes;
  std::atomic<uint64_t> graph_generation;
  TableHead processes;
  TableHead nodes;
  TableHead endpoints;
  uint32_t topic_count;
  uint32_t closing_count;                  ///< number of slots in `closing` (derived)
  std::atomic<uint64_t> clusters_present;  ///< bit c - 1: cluster c has a segment
  std::atomic<uint32_t> removed;           ///< 1 = the files are removed; no process can join
  uint32_t needs_repair;  ///< an owner of the mutex died and its changes are not repaired yet
  uint32_t last_order;    ///< largest EndpointEntry::order
  TraceControl trace;
  /// Processes of which a thread has ever watched the graph. A thread adds its process before it
  /// adds its wake word to WakeWords::graph; the slot is removed when it is given back and when it
  /// is taken anew. Model: docs/model/waiting.pml.
  GraphWatchers graph_watchers;
  ClosingEndpoints closing;           ///< endpoints for which is_closed() holds (derived)
  std::atomic<uint64_t> death_count;  ///< incremented after the entry in `deaths` is written
  Death deaths[kept_deaths];  ///< ring; the next death goes to index death_count mod kept_deaths
  TopicBucket topic_buckets[topic_bucket_count];
  Hand hands[lifeline_count];  ///< by line
  LockBadge badges[lock_badge_count];
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
