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

/// Removes incomplete trace files of processes killed while creating them.
void remove_unfinished_traces(const Registry & registry);

/// Events recorded by one process.
struct ProcessTrace {
  uint32_t cluster = 0;
  std::optional<uint32_t> process;  ///< slot; empty for a receive thread
  int32_t pid = 0;
  int32_t core = -1;
  int32_t host_cpu = -1;
  std::string label;
  bool alive = false;
  std::vector<ThreadTrace> threads;
  std::vector<TraceName> names;
  uint64_t unplaced = 0;  ///< events of threads that got no ring
};

/// Reads the recorded events of a platform. One instance at a time: holds a lock during its
/// lifetime.
class TraceSaver {
public:
  /// Throws Error{timeout} if another process is saving or the registry stays locked, and
  /// Error{corrupt} naming a file.
  explicit TraceSaver(Registry & registry);

  /// Events recorded and not saved before.
  const std::vector<ProcessTrace> & processes() const noexcept { return processes_; }
  /// Events of processes that could not create a file.
  uint64_t unplaced() const noexcept { return unplaced_; }
  /// Marks the events as saved: frees their ring space, and removes the files of ended processes.
  void finish() noexcept;

private:
  bool is_writer_alive(const TraceFileHeader & header) const;

  Registry & registry_;
  std::optional<FileLock> lock_;
  std::vector<TraceReader> readers_;
  std::vector<ProcessTrace> processes_;
  uint64_t unplaced_total_ = 0;
  uint64_t unplaced_ = 0;
  /// Start of the trace if it was stopped before its events were read, else 0.
  int64_t stopped_trace_ns_ = 0;
};

/// Discards recorded events that are not saved. Throws like TraceSaver.
void discard_trace(Registry & registry);

}  // namespace manycore
