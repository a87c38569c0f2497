// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "ndt/matching/matcher.hpp"
#include "ndt/optimisation/newton.hpp"
#include "platform/futex.hpp"

namespace manycore::ndt {

constexpr size_t most_workers = 64;

/// A part of shared memory that others attach to; `id` changes when it is another.
struct SharedPart {
  uint64_t id;
  char path[64];
};

/// What the workers are to do; written by the coordinator while all of them sleep.
struct Job {
  SharedPart maps[max_levels];  ///< coarsest first; workers keep these attached and no others
  uint32_t levels;              ///< 0: only to see whether all workers are there
  uint32_t first_level;         ///< to align on
  SharedPart scan;
  uint64_t points;
  MatchOptions options;
  Pose6 guess;
  bool has_regularization;
  Regularization regularization;
  int64_t spin_ns;  ///< how long to look before sleeping at a barrier
};
static_assert(std::is_trivially_copyable_v<Job>);

/// A worker's own cache line, which the others read.
struct alignas(64) WorkerLine {
  std::atomic<uint64_t> arrived;   ///< ticket of the pass it has reached the barrier of
  std::atomic<uint32_t> finished;  ///< job it is done with
  std::atomic<uint32_t> pinned;    ///< 1 once it runs on its host CPU alone
  std::atomic<uint64_t> busy_ns;   ///< time of the last job outside barriers
};
static_assert(sizeof(WorkerLine) == 64 && std::atomic<uint64_t>::is_always_lock_free);

/// When a worker worked for a pass, CLOCK_MONOTONIC.
struct WorkerPass {
  int64_t begin_ns;
  int64_t end_ns;
};
/// Passes of an alignment that are kept: more than one takes, but for options out of the ordinary.
constexpr uint32_t max_kept_passes = 256;

/// What a worker did in the last job; written by it, read once the job is over.
struct WorkerLog {
  uint32_t passes;  ///< in all, also those that are not kept
  std::array<WorkerPass, max_kept_passes> kept;
};

/// A pass of a job; greater than all before it.
inline uint64_t ticket_of(uint32_t job, uint32_t pass) { return (uint64_t{job} << 24) + pass; }
inline uint32_t job_of(uint64_t ticket) { return static_cast<uint32_t>(ticket >> 24); }

/// A worker's bins of a pass: those from its index in steps of the number of workers. It begins
/// them in this order, and so does everybody who is done with his own.
struct alignas(64) Share {
  std::atomic<uint64_t> begun;  ///< ticket * 2^8 + how many are begun

  /// Begins another bin; empty when all of this pass are begun.
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

/// Where processes wait for what others do. Zero is its initial state.
struct alignas(64) Gate {
  FutexWord events;
  std::atomic<uint32_t> sleepers;
};

/// The shared memory of a coordinator and its workers. Zero is its initial state.
struct Session {
  /// Number of the last job; workers sleep on it.
  alignas(64) FutexWord job;
  /// A job that cannot be finished because a worker died.
  alignas(64) std::atomic<uint32_t> aborted;
  Gate barrier;  ///< workers wait for each other between passes
  Gate end;      ///< the coordinator waits for the end of a job
  uint32_t workers;
  Job what;
  NewtonResult result;  ///< written by worker 0
  std::array<WorkerLine, most_workers> lines;
  std::array<Share, most_workers> shares;
  std::array<WorkerLog, most_workers> logs;
  /// Of even and odd passes: who is ahead by one must not overwrite what others still add up.
  alignas(64) TangentSums bins[2][bin_count];
};

inline void announce(Gate & gate) noexcept {
  gate.events.fetch_add(1, std::memory_order_seq_cst);
  if (gate.sleepers.load(std::memory_order_seq_cst) != 0) {
    futex_wake_all(gate.events);
  }
}

/// Sleeps until `is_due` holds or the time has come; announce() makes sleepers look again. Between
/// the count of sleepers and the sleep lies another look: whoever announces after it finds us
/// counted, whoever announced before it has changed `events`.
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
