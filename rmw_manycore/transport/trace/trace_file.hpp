// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "platform/fork_side.hpp"
#include "platform/shared_memory.hpp"
#include "transport/trace/trace_ring.hpp"

namespace manycore {

/// Of which process a trace file is.
struct TraceIdentity {
  uint64_t platform_nonce = 0;
  uint32_t cluster = 0;
  uint32_t process = UINT32_MAX;  ///< slot; UINT32_MAX = a receive thread
  uint32_t incarnation = 0;
  int32_t core = -1;
  int32_t host_cpu = -1;
  std::string label;
};

/// A trace file that is not complete, as its name tells: savers do not look for it, and where the
/// process that makes it has ended it is in no use.
struct UnfinishedTrace {
  uint32_t line;  ///< lifeline of that process
  pid_t pid;      ///< of it, in its own PID namespace

  /// What the file is called until it becomes `path`.
  static std::string path_of(const std::string & path, const TraceIdentity & identity);
  /// Nothing for a file of another kind.
  static std::optional<UnfinishedTrace> of(const std::string & name);
};

/// The file that a traced process writes its events to: a ring for each thread, and the names of
/// the endpoints they are about. It outlives its process. Thread-safe; useless in a child of
/// fork().
class TraceFile {
public:
  /// Throws Error{no_space|system}.
  TraceFile(const std::string & path, const TraceIdentity & identity, uint32_t events_log2);

  /// A ring of the calling thread's own; nothing when all are taken or there is no memory.
  std::optional<TraceRingWriter> add_ring() noexcept;
  void push(TraceRingWriter & ring, const TraceEvent & event) noexcept {
    ring.push(event, [&](uint64_t backed) { return back(ring.ring(), backed); });
  }
  /// Of what is noted again and again: where there is no room, the next one will do.
  void push_sample(TraceRingWriter & ring, const TraceEvent & event) noexcept {
    ring.try_push(event, [&](uint64_t backed) { return back(ring.ring(), backed); });
  }
  void count_unplaced() noexcept { header().unplaced.fetch_add(1, std::memory_order_relaxed); }
  /// Drops it silently where there is no room: the event then has a number in place of a name.
  void add_name(const TraceName & name) noexcept;
  bool is_inherited() const noexcept { return side_.is_inherited(); }
  /// True once for each period: the process's counters are to be noted.
  bool is_sample_due(int64_t now_ns) noexcept {
    int64_t due_ns = sample_due_ns_.load(std::memory_order_relaxed);
    return now_ns >= due_ns && sample_due_ns_.compare_exchange_strong(
                                 due_ns, now_ns + sample_period_ns, std::memory_order_relaxed);
  }

private:
  static constexpr int64_t sample_period_ns = 10'000'000;

  void describe(const TraceIdentity & identity, uint32_t events_log2) const noexcept;
  TraceFileHeader & header() const noexcept { return memory_.at<TraceFileHeader>(0); }
  TraceRing * free_ring() noexcept;
  /// Backs a step of a ring's events; returns how many are backed.
  uint64_t back(const TraceRing & ring, uint64_t backed) const noexcept;
  bool try_back(uint64_t offset, uint64_t length) const noexcept;

  const ForkSide side_;
  SharedMemory memory_;
  std::atomic<int64_t> sample_due_ns_{0};
  std::mutex mutex_;  ///< of rings and names being added
};

}  // namespace manycore
