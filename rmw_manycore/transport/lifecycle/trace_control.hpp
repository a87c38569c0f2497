// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore {

/// What to trace. Everything if both lists are empty.
struct TraceSelection {
  std::vector<uint32_t> clusters;
  std::vector<std::string> nodes;  ///< full names
  uint32_t events = 0;             ///< minimum capacity of a thread's ring in events; 0 = default
};

/// State of tracing on a platform.
struct TraceState {
  int64_t started_ns = 0;  ///< CLOCK_MONOTONIC; 0 = nothing is traced
  std::vector<uint32_t> clusters;
  std::vector<std::string> nodes;
  uint64_t ring_events = 0;
  uint64_t pending = 0;  ///< events not saved yet
  uint64_t lost = 0;     ///< lost events not reported in a saved trace yet
};

/// Starts tracing the selected processes, including those that join later. Throws
/// Error{invalid_argument} if a trace is running or not saved, or if a selected node or cluster
/// does not exist.
void start_trace(Registry & registry, const TraceSelection & selection);

/// Stops tracing. Recorded events stay until they are saved or the platform ends. Throws
/// Error{invalid_argument} if no trace is running.
void stop_trace(Registry & registry);

/// Ignores trace files that cannot be read: their events are not counted.
TraceState trace_state(Registry & registry);

/// Identity of the process in a slot, for its trace file.
TraceIdentity identity_of(Registry & registry, uint32_t process);

/// Trace scope of a process of `cluster` that joins now. The caller holds the registry lock.
TraceScope scope_of_new_process(const RegistryHeader & header, uint32_t cluster) noexcept;

}  // namespace manycore
