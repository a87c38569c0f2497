// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "platform/fork_side.hpp"
#include "platform/process_identity.hpp"
#include "platform/shared_memory.hpp"
#include "transport/trace/trace_ring.hpp"

namespace manycore {

/// Identity of the process that writes a trace file.
struct TraceIdentity {
  uint64_t platform_nonce = 0;
  uint32_t cluster = 0;
  uint32_t process = UINT32_MAX;  ///< slot; UINT32_MAX = a receive thread
  uint32_t incarnation = 0;       ///< of the slot; see receive_thread_incarnation()
  int32_t core = -1;
  int32_t host_cpu = -1;
  std::string label;
};

/// Distinguishes a receive thread from the one that it replaced, which may have had its pid.
inline uint32_t receive_thread_incarnation(const ProcessIdentity & holder) {
  return static_cast<uint32_t>(holder.start_time);
}

/// A trace file under construction, recognized by its name. Savers ignore it; if its process has
/// ended, it can be removed.
struct UnfinishedTrace {
  uint32_t line;        ///< lifeline of its process
  pid_t pid;            ///< in the PID namespace of its process
  uint64_t start_time;  ///< of its process, as in ProcessIdentity

  /// Name of the file until it is renamed to `path`.
  static std::string path_of(const std::string & path, const TraceIdentity & identity);
  /// Nothing if `name` is not an unfinished trace file.
  static std::optional<UnfinishedTrace> of(const std::string & name);
};

/// The file to which a traced process writes its events: one ring per thread, and the names of the
/// endpoints in the events. Outlives its process. Thread-safe; not usable in a child of fork().
class TraceFile {
public:
  /// Throws Error{no_space|system}.
  TraceFile(const std::string & path, const TraceIdentity & identity, uint32_t events_log2);

  /// A ring for the calling thread; nothing if all rings are in use or there is no memory.
  std::optional<TraceRingWriter> add_ring() noexcept;
  void push(TraceRingWriter & ring, const TraceEvent & event) noexcept {
    ring.push(event, [&](uint64_t backed) { return back(ring.ring(), backed); });
  }
  /// For periodic samples: a dropped one is not counted as lost.
  void push_sample(TraceRingWriter & ring, const TraceEvent & event) noexcept {
    ring.try_push(event, [&](uint64_t backed) { return back(ring.ring(), backed); });
  }
  void count_unplaced() noexcept { header().unplaced.fetch_add(1, std::memory_order_relaxed); }
  /// Drops the name if there is no room; the event then has a slot number only.
  void add_name(const TraceName & name) noexcept;
  bool is_inherited() const noexcept { return side_.is_inherited(); }
  /// True once per period, for one caller: the process's counters should be sampled.
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
  /// Backs the next step of a ring's events; returns how many are backed.
  uint64_t back(const TraceRing & ring, uint64_t backed) const noexcept;
  bool try_back(uint64_t offset, uint64_t length) const noexcept;

  const ForkSide side_;
  SharedMemory memory_;
  std::atomic<int64_t> sample_due_ns_{0};
  std::mutex mutex_;  ///< guards adding rings and names
};

}  // namespace manycore
