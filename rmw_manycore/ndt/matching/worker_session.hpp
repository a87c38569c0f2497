// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "ndt/matching/matcher.hpp"
#include "ndt/optimisation/newton.hpp"
#include "ndt/search/place_search.hpp"
#include "platform/futex.hpp"

namespace manycore::ndt {

constexpr size_t max_workers = 64;

/// A shared memory object to attach to; `id` changes when it is replaced.
struct SharedPart {
  uint64_t id;
  char path[64];
};

enum class JobKind : uint32_t { align, search };

/// Parameters of a job; written by the coordinator while all workers sleep.
struct Job {
  JobKind kind;
  SharedPart maps[max_levels];  ///< coarsest first; workers keep only these attached
  uint32_t levels;              ///< 0 = only check that all workers run
  uint32_t first_level;         ///< level to start the alignment on
  uint32_t end_level;           ///< behind the last level of the alignment
  uint32_t polishing;           ///< number of the last of these that only refine the pose
  double surpassed;             ///< score that other starts reached
  double min_fit;               ///< that a result has to exceed to be refined
  SharedPart scan;
  uint64_t points;
  MatchOptions options;
  Pose6 guess;
  bool has_regularization;
  Regularization regularization;
  int64_t spin_ns;  ///< time in ns to spin at a barrier before sleeping
  SharedPart search_map;
  SharedPart search;
  SearchPhase search_phase;
  int64_t search_end_ns;  ///< CLOCK_MONOTONIC; no part of a search is begun after it
};
static_assert(std::is_trivially_copyable_v<Job>);

/// One cache line per worker, read by the others.
struct alignas(64) WorkerLine {
  std::atomic<uint64_t> arrived;   ///< ticket of the pass whose barrier it has reached
  std::atomic<uint32_t> finished;  ///< number of the last job it has finished
  std::atomic<uint32_t> pinned;    ///< 1 once its affinity mask is a single host CPU
  std::atomic<uint64_t> busy_ns;   ///< time of the last job outside barriers
};
static_assert(sizeof(WorkerLine) == 64 && std::atomic<uint64_t>::is_always_lock_free);

/// Begin and end of a worker's share of a pass, CLOCK_MONOTONIC.
struct WorkerPass {
  int64_t begin_ns;
  int64_t end_ns;
};
/// Recorded passes per alignment; more than an alignment takes with usual options.
constexpr uint32_t max_kept_passes = 256;

/// Log of a worker for the last job; written by the worker, read after the job.
struct WorkerLog {
  uint32_t passes;  ///< number of passes, including those not recorded
  std::array<WorkerPass, max_kept_passes> kept;
};

/// Identifies a pass of a job; greater than all earlier tickets.
inline uint64_t ticket_of(uint32_t job, uint32_t pass) { return (uint64_t{job} << 24) + pass; }
inline uint32_t job_of(uint64_t ticket) { return static_cast<uint32_t>(ticket >> 24); }

/// A worker's bins of a pass: from its index on, in steps of the number of workers. The worker
/// begins them in this order, and so do workers that have finished their own share.
struct alignas(64) Share {
  std::atomic<uint64_t> begun;  ///< ticket * 2^8 + number of bins begun

  /// Begins the next bin; empty if all bins of this pass are begun.
  std::optional<size_t> begin(uint64_t ticket, size_t first, size_t workers) noexcept {
    uint64_t seen = begun.load(std::memory_order_relaxed);
    for (;;) {
      const uint64_t before = seen >> 8 == ticket ? seen & 0xFF : 0;
      const size_t bin = first + before * workers;
      if (bin >= bin_count) {
        return std::nullopt;
      }
      const uint64_t after = (ticket << 8) + before + 1;
      if (begun.compare_exchange_weak(seen, after, std::memory_order_relaxed)) {
        return bin;
      }
    }
  }
};
static_assert(bin_count < 256);

/// Event counter on which processes wait for each other. Zero-initialized.
struct alignas(64) Gate {
  FutexWord events;
  std::atomic<uint32_t> sleepers;
};

/// Memory shared by a coordinator and its workers. Zero-initialized.
struct Session {
  /// Number of the last job; workers sleep on it.
  alignas(64) FutexWord job;
  /// Number of a job that cannot be finished because a worker died.
  alignas(64) std::atomic<uint32_t> aborted;
  Gate barrier;  ///< workers wait for each other between passes
  Gate end;      ///< the coordinator waits for the end of a job
  uint32_t workers;
  Job what;
  NewtonResult result;  ///< written by worker 0
  std::array<WorkerLine, max_workers> lines;
  std::array<Share, max_workers> shares;
  std::array<WorkerLog, max_workers> logs;
  /// Bins of even and odd passes: a worker one pass ahead must not overwrite bins that others still
  /// sum.
  alignas(64) TangentSums bins[2][bin_count];
};

/// Wakes the processes that sleep at the gate, to check their condition again.
inline void announce(Gate & gate) noexcept {
  gate.events.fetch_add(1, std::memory_order_seq_cst);
  if (gate.sleepers.load(std::memory_order_seq_cst) != 0) {
    futex_wake_all(gate.events);
  }
}

/// Sleeps until `is_due` holds or `deadline_ns` (CLOCK_MONOTONIC) passes; announce() makes sleepers
/// check again. No wake-up is lost: the sleeper increments `sleepers` before it loads `events` and
/// checks, and an announcer increments `events` before it loads `sleepers`, all seq_cst. An
/// announcer that misses the sleeper has changed `events` before the sleeper loaded it, so the
/// sleeper's check sees the cause.
template<typename Condition>
bool sleep_until(Gate & gate, Condition is_due, std::optional<int64_t> deadline_ns) {
  gate.sleepers.fetch_add(1, std::memory_order_seq_cst);
  bool due = false;
  for (;;) {
    const uint32_t seen = gate.events.load(std::memory_order_seq_cst);
    due = is_due();
    if (due || (deadline_ns && monotonic_ns() >= *deadline_ns)) {
      break;
    }
    futex_wait(gate.events, seen, deadline_ns);
  }
  gate.sleepers.fetch_sub(1, std::memory_order_seq_cst);
  return due;
}

}  // namespace manycore::ndt
