// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore {

/// What to trace; everything where nothing is named.
struct TraceSelection {
  std::vector<uint32_t> clusters;
  std::vector<std::string> nodes;  ///< full names
  uint32_t events = 0;  ///< that a thread's ring holds, at least; 0 = as before, or usual
};

struct TraceState {
  int64_t started_ns = 0;  ///< CLOCK_MONOTONIC; 0 = nothing is traced
  std::vector<uint32_t> clusters;
  std::vector<std::string> nodes;
  uint64_t ring_events = 0;
  uint64_t pending = 0;  ///< events that were not saved yet
  uint64_t lost = 0;     ///< events that no saved trace has told as lost
};

/// From now on the selected processes record what they do, those that join later included. Throws
/// Error{invalid_argument} when a trace is on already or was not saved, or for what is not there.
void start_trace(Registry & registry, const TraceSelection & selection);

/// What was recorded stays until it is saved, or the platform ends. Throws Error{invalid_argument}
/// when nothing is traced.
void stop_trace(Registry & registry);

/// Also where a trace file cannot be read: its events do not count then.
TraceState trace_state(Registry & registry);

/// Of the process in a slot, for its trace file.
TraceIdentity identity_of(Registry & registry, uint32_t process);

/// How a process of `cluster` that joins now is traced; under the registry lock.
TraceScope scope_of_new_process(const RegistryHeader & header, uint32_t cluster) noexcept;

}  // namespace manycore
