// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "transport/layout/segment_layout.hpp"

namespace manycore {

constexpr uint64_t trace_magic = 0x4d43'5452'4143'4531;  // "MCTRACE1"

/// Which events of a process are recorded.
enum class TraceScope : uint32_t {
  off,
  all,
  some_nodes,  ///< events of nodes whose NodeEntry::traced is set, and events without a node
};
/// Loaded at each trace site, so it lies in a cache line that is rarely written.
using TraceSwitch = std::atomic<TraceScope>;
static_assert(TraceSwitch::is_always_lock_free);

/// Kind of a TraceEvent. Unless stated otherwise, `endpoint` is the acting endpoint, `number` the
/// record number, and `value` is unused. Kinds are named as in docs/design/trace.md.
enum class TraceKind : uint16_t {
  none,
  publish_begin,    ///< value: bytes requested
  serialize_begin,  ///< the record has its room and number
  write,            ///< before readers can see the record; value: bytes
  publish_end,
  send,        ///< before an eMCOS message is written; value: cluster
  receive,     ///< a receive thread read an eMCOS message; value: cluster
  hint,        ///< before a hint is pushed; endpoint: subscription; value: publisher
  wake,        ///< before a process is notified; value: number of wake words
  wait_begin,  ///< number: as of wait_end; value: timeout in ns; UINT64_MAX = none
  wait_end,    ///< number: CPU time of the thread in ns, or 0; value: 1 = some entity is ready
  claim,       ///< value: publisher
  release,     ///< value: publisher
  request,     ///< a request was written or claimed; value: request number of the client
  reply,       ///< a reply was written or claimed; value: request number of the client
  lost,        ///< value: number of messages
  expired,     ///< value: publisher
  refused,     ///< publishing failed
  blocked,     ///< RELIABLE + KEEP_ALL: the publisher starts waiting for a reader
  match,       ///< value: the other endpoint
  join,        ///< a process joined
  leave,       ///< a process left
  cpu,         ///< value: CPU time used by the process in ns
  smem,        ///< number: cluster; value: bytes of SMEM in use
  bridge_in,   ///< before a message from outside is published; value: its age in ns
  bridge_out,  ///< the claimed message was published outside
  align,       ///< a scan was aligned; number: begin, value: end, both CLOCK_MONOTONIC
  resume,      ///< continues what thread `endpoint` of this process did at time `number`
  pass,        ///< as `align`, for a worker's share of a pass; endpoint: worker; incarnation: pass
  hand,        ///< a record is handed to its transfer; value: receiving cluster
  arrive,      ///< a record has arrived in a receiving cluster; value: cluster
  drop,        ///< a record does not reach a receiving cluster; value: cluster
  in_place,    ///< written or read where the record lies, without a copy; value: publisher
  superseded,  ///< value: number of messages
};

/// Slot and incarnation of an endpoint packed into one word.
constexpr uint64_t trace_endpoint(uint32_t slot, uint32_t incarnation) noexcept {
  return uint64_t{incarnation} << 32 | slot;
}

/// One recorded event.
struct TraceEvent {
  int64_t time_ns;  ///< CLOCK_MONOTONIC
  uint64_t number;
  uint64_t value;
  uint32_t endpoint;     ///< slot, or `nothing`
  uint16_t incarnation;  ///< of the slot; low 16 bits
  TraceKind kind;
};
static_assert(sizeof(TraceEvent) == 32 && std::is_trivially_copyable_v<TraceEvent>);

/// free -> used -> ended -> used. A thread may take over an ended ring once all its events are
/// saved.
enum class TraceRingState : uint32_t { free, used, ended };

/// Events of one thread: one writer, one saver. The writer owns `written`, the saver `read`; both
/// only grow, and the ring holds written - read events.
struct alignas(64) TraceRing {
  std::atomic<TraceRingState> state;
  int32_t tid;      ///< stored, like `name`, before the ring's first event
  char name[16];    ///< of the thread
  uint64_t offset;  ///< of the events, in the trace file
  uint64_t backed;  ///< events backed with memory; owned by the writer
  uint64_t reserved[3];
  alignas(64) std::atomic<uint64_t> written;
  std::atomic<uint64_t> lost;  ///< events dropped because the ring was full
  alignas(64) std::atomic<uint64_t> read;
  std::atomic<uint64_t> lost_saved;  ///< part of `lost` already reported in a saved trace
};
static_assert(sizeof(TraceRing) == 192);

constexpr uint32_t trace_rings_per_process = 64;
constexpr uint32_t trace_names_per_process = 1024;

/// Names of an endpoint, recorded with its first event because the endpoint may be gone when the
/// trace is saved.
struct TraceName {
  uint32_t slot;
  uint32_t incarnation;
  uint32_t process;
  uint32_t cluster;
  uint8_t kind;  ///< EndpointKind
  uint8_t role;  ///< EndpointRole
  uint8_t reserved[6];
  char topic[256];
  char type[256];
  char node[512];  ///< namespace and name
};
static_assert(sizeof(TraceName) == 1048);

/// Head of the trace file of a process.
struct TraceFileHeader {
  SegmentHeader segment;
  uint32_t process;      ///< slot; `nothing` = a receive thread
  uint32_t incarnation;  ///< of that slot
  pid_t pid;
  int32_t core;          ///< -1 = not placed on a core
  int32_t host_cpu;      ///< -1 = not pinned
  uint32_t events_log2;  ///< of each ring
  char label[88];
  std::atomic<uint32_t> ring_count;
  std::atomic<uint32_t> name_count;
  std::atomic<uint64_t> unplaced;  ///< events of threads that got no ring
  std::atomic<uint64_t> unplaced_saved;
  TraceRing rings[trace_rings_per_process];
};
static_assert(offsetof(TraceFileHeader, rings) == 192);

constexpr uint64_t trace_names_offset = 16384;
static_assert(sizeof(TraceFileHeader) <= trace_names_offset);
constexpr uint64_t trace_events_offset =
  (trace_names_offset + uint64_t{trace_names_per_process} * sizeof(TraceName) + 4095) / 4096 * 4096;
constexpr uint32_t min_trace_events_log2 = 7;   ///< one page
constexpr uint32_t max_trace_events_log2 = 24;  ///< 512 MiB

constexpr uint64_t trace_file_bytes(uint32_t events_log2) {
  return trace_events_offset +
         uint64_t{trace_rings_per_process} * (sizeof(TraceEvent) << events_log2);
}

/// Tracing state in the registry header. Changed under the registry lock, except for the counters.
struct TraceControl {
  std::atomic<int64_t> started_ns;  ///< CLOCK_MONOTONIC; 0 = not tracing
  /// Bit c - 1: trace all of cluster c, including processes that join later.
  std::atomic<uint64_t> clusters;
  std::atomic<uint32_t> events_log2;  ///< of rings created from now on
  std::atomic<uint32_t> files;        ///< files created so far; numbers their names
  std::atomic<uint64_t> unplaced;     ///< events of processes that could not create a file
  std::atomic<uint64_t> unplaced_saved;
  std::atomic<int64_t> unsaved_since_ns;      ///< start of the last trace; 0 = stopped and saved
  TraceSwitch receive_threads[max_clusters];  ///< index cluster - 1
};
static_assert(sizeof(TraceControl) == 304);

}  // namespace manycore
