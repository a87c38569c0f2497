// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "platform/shared_memory.hpp"
#include "transport/layout/trace_layout.hpp"

namespace manycore {

/// Events that one thread recorded and that are not saved yet.
struct ThreadTrace {
  int32_t tid = 0;
  std::string name;
  std::vector<TraceEvent> events;  ///< oldest first
  uint64_t lost = 0;               ///< events dropped because the ring was full
};

/// Reading side of one trace file; one at a time (see TraceSaver). Never blocks the writers.
class TraceReader {
public:
  /// Throws Error{corrupt|system} naming the file.
  TraceReader(const std::string & path, uint64_t platform_nonce);

  const std::string & path() const noexcept { return memory_.path(); }
  const TraceFileHeader & header() const noexcept { return memory_.at<TraceFileHeader>(0); }
  /// Events currently in the file.
  uint64_t pending() const noexcept;
  /// Lost events not reported in a saved trace yet.
  uint64_t lost() const noexcept;

  /// Copies the recorded events. Throws Error{corrupt}.
  std::vector<ThreadTrace> read();
  std::vector<TraceName> names() const;
  /// Unplaced events, as of the last read().
  uint64_t unplaced() const noexcept { return unplaced_; }
  /// Marks the events of the last read() as saved and frees their space.
  void free_read() noexcept;
  /// True if nothing was recorded since the last read().
  bool is_drained() const noexcept;

private:
  struct Position {
    uint64_t written = 0;
    uint64_t lost = 0;
  };

  TraceFileHeader & header() noexcept { return memory_.at<TraceFileHeader>(0); }
  uint32_t ring_count() const noexcept;
  uint64_t capacity() const noexcept { return uint64_t{1} << header().events_log2; }
  ThreadTrace read_ring(uint32_t index);
  [[noreturn]] void refuse(const std::string & why) const;

  SharedMemory memory_;
  std::array<Position, trace_rings_per_process> seen_{};
  uint32_t rings_seen_ = 0;
  uint64_t unplaced_total_ = 0;
  uint64_t unplaced_ = 0;
};

}  // namespace manycore
