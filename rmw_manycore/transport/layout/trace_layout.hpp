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
  some_nodes,  ///< those of nodes whose entry says so, and those that belong to no node
};
/// Read by each trace site, so it lies in a cache line that is seldom written.
using TraceSwitch = std::atomic<TraceScope>;
static_assert(TraceSwitch::is_always_lock_free);

/// What happened. `endpoint`, `number` and `value` of TraceEvent mean, where not said otherwise:
/// the endpoint that acts, the record's number, and nothing. Names: see docs/design/trace.md.
enum class TraceKind : uint16_t {
  none,
  publish_begin,    ///< value: bytes asked for
  serialize_begin,  ///< the record has its place and number
  write,            ///< before the record can be seen; value: bytes
  publish_end,
  send,        ///< before an eMCOS message is sent; value: cluster
  receive,     ///< a receive thread has an eMCOS message; value: cluster
  hint,        ///< before it is pushed; endpoint: subscription; value: publisher
  wake,        ///< before a process is notified; value: number of wake words
  wait_begin,  ///< value: timeout in ns, UINT64_MAX = none
  wait_end,    ///< value: 1 = something is ready
  claim,       ///< value: publisher
  release,     ///< value: publisher
  request,     ///< a request is written or claimed; value: the client's number
  reply,       ///< the same of a reply
  lost,        ///< value: how many
  expired,     ///< value: publisher
  refused,     ///< a publish failed
  blocked,     ///< RELIABLE + KEEP_ALL: the publisher starts to wait
  match,       ///< value: the other endpoint
  join,        ///< of the process
  leave,       ///< of the process
  cpu,         ///< value: CPU time that the process has used, in ns
  smem,        ///< number: cluster; value: bytes of its SMEM that are used
  bridge_in,   ///< before a message from outside is published; value: its age in ns
  bridge_out,  ///< the message that is claimed was published outside
  align,       ///< a scan was matched; number: begin, value: end, both of CLOCK_MONOTONIC
  resume,      ///< goes on with what thread `endpoint` of the process did at time `number`
  pass,        ///< as `align`, of a worker's share of a pass; endpoint: worker; incarnation: pass
};

/// Slot and incarnation of an endpoint in one word.
constexpr uint64_t trace_endpoint(uint32_t slot, uint32_t incarnation) noexcept {
  return uint64_t{incarnation} << 32 | slot;
}

struct TraceEvent {
  int64_t time_ns;  ///< CLOCK_MONOTONIC
  uint64_t number;
  uint64_t value;
  uint32_t endpoint;     ///< slot, or `nothing`
  uint16_t incarnation;  ///< of the slot, low bits
  TraceKind kind;
};
static_assert(sizeof(TraceEvent) == 32 && std::is_trivially_copyable_v<TraceEvent>);

/// free -> used -> ended -> used. An ended ring is used again once all its events were saved.
enum class TraceRingState : uint32_t { free, used, ended };

/// Events of one thread: one writer, one saver. `written` is the writer's, `read` the saver's; both
/// only grow, and `written - read` events are there.
struct alignas(64) TraceRing {
  std::atomic<TraceRingState> state;
  int32_t tid;      ///< with `name`: stored before the ring's first event
  char name[16];    ///< of the thread
  uint64_t offset;  ///< of the events, in the file
  uint64_t backed;  ///< events that have memory; the writer's
  uint64_t reserved[3];
  alignas(64) std::atomic<uint64_t> written;
  std::atomic<uint64_t> lost;  ///< events for which there was no room
  alignas(64) std::atomic<uint64_t> read;
  std::atomic<uint64_t> lost_saved;  ///< how many of `lost` were told in a saved trace
};
static_assert(sizeof(TraceRing) == 192);

constexpr uint32_t trace_rings_per_process = 64;
constexpr uint32_t trace_names_per_process = 1024;

/// What an endpoint was called when its first event was recorded: it may be gone when the trace is
/// saved.
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

/// Head of a process's trace file.
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
  std::atomic<uint64_t> unplaced;  ///< events of threads that found no ring
  std::atomic<uint64_t> unplaced_saved;
  TraceRing rings[trace_rings_per_process];
};
static_assert(offsetof(TraceFileHeader, rings) == 192);

constexpr uint64_t trace_names_offset = 16384;
static_assert(sizeof(TraceFileHeader) <= trace_names_offset);
constexpr uint64_t trace_events_offset =
  (trace_names_offset + uint64_t{trace_names_per_process} * sizeof(TraceName) + 4095) / 4096 * 4096;
constexpr uint32_t min_trace_events_log2 = 7;   ///< a page
constexpr uint32_t max_trace_events_log2 = 24;  ///< 512 MiB

constexpr uint64_t trace_file_bytes(uint32_t events_log2) {
  return trace_events_offset +
         uint64_t{trace_rings_per_process} * (sizeof(TraceEvent) << events_log2);
}

/// In the registry's header. Changed under the registry lock, but for the counts.
struct TraceControl {
  std::atomic<int64_t> started_ns;    ///< CLOCK_MONOTONIC; 0 = nothing is traced
  std::atomic<uint64_t> clusters;     ///< bit c - 1: all of cluster c, also what joins later
  std::atomic<uint32_t> events_log2;  ///< of rings made from now on
  std::atomic<uint32_t> files;        ///< made so far; their names count
  std::atomic<uint64_t> unplaced;     ///< events of processes that could make no file
  std::atomic<uint64_t> unplaced_saved;
  std::atomic<int64_t> unsaved_since_ns;  ///< start of the last trace; 0 = it is stopped and saved
  TraceSwitch receive_threads[max_clusters];  ///< index cluster - 1
};
static_assert(sizeof(TraceControl) == 304);

}  // namespace manycore
