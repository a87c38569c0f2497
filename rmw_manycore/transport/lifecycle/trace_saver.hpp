// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/file_lock.hpp"
#include "transport/registry/registry.hpp"
#include "transport/trace/trace_reader.hpp"

namespace manycore {

/// Paths of a platform's trace files.
std::vector<std::string> trace_files(const PlatformPaths & paths);

/// Removes the trace files that processes were making when they were killed.
void remove_unfinished_traces(const Registry & registry);

/// What one process recorded.
struct ProcessTrace {
  uint32_t cluster = 0;
  std::optional<uint32_t> process;  ///< slot; none: a receive thread
  int32_t pid = 0;
  int32_t core = -1;
  int32_t host_cpu = -1;
  std::string label;
  bool alive = false;
  std::vector<ThreadTrace> threads;
  std::vector<TraceName> names;
  uint64_t unplaced = 0;  ///< events of threads that found no ring
};

/// Takes the recorded events out of a platform. One at a time: holds a lock while alive.
class TraceSaver {
public:
  /// Throws Error{timeout} when another process saves, or the registry stays locked;
  /// Error{corrupt} naming a file.
  explicit TraceSaver(Registry & registry);

  /// What was recorded and not saved so far.
  const std::vector<ProcessTrace> & processes() const noexcept { return processes_; }
  /// Events of processes that could make no file.
  uint64_t unplaced() const noexcept { return unplaced_; }
  /// What was found is saved now: gives its room back, and that of processes that are gone.
  void finish() noexcept;

private:
  bool is_writer_alive(const TraceFileHeader & header) const;

  Registry & registry_;
  std::optional<FileLock> lock_;
  std::vector<TraceReader> readers_;
  std::vector<ProcessTrace> processes_;
  uint64_t unplaced_total_ = 0;
  uint64_t unplaced_ = 0;
  int64_t stopped_trace_ns_ =
    0;  ///< start of the trace, if it was stopped before its events were read
};

/// Throws away what was recorded and not saved. Throws as TraceSaver.
void discard_trace(Registry & registry);

}  // namespace manycore
