// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "platform/clock.hpp"
#include "platform/futex.hpp"
#include "virtual_time/door.hpp"

/// Memory shared by the timekeeper of a run and the processes that live in its time.
namespace manycore::virtual_time {

constexpr uint64_t page_magic = 0x6d63'7674'696d'6531;
/// Threads of one run that may wait at a time.
constexpr uint32_t seat_capacity = 2048;
/// Subscriptions are in slots below.
constexpr uint32_t subscription_capacity = 32768;
/// 2001-09-09: late enough for programs that subtract from it, early enough not to be mistaken.
constexpr int64_t start_ns = 1'000'000'000 * ns_per_s;
constexpr int64_t never_ns = INT64_MAX;

/// | from    | to      | by                                               |
/// |---------|---------|--------------------------------------------------|
/// | free    | running | a thread that took it, and has written its ids |
/// | running | waiting | that thread, once it has written its wait        |
/// | waiting | running | the timekeeper; the thread itself at the end     |
/// | running | free    | the thread at its end; the timekeeper, when      |
/// | waiting | free    | the process has died                             |
enum SeatState : uint32_t { seat_free, seat_running, seat_waiting };

/// A thread's place in the timekeeper's order. The thread writes all but `state` while it runs; the
/// timekeeper reads them while the thread waits.
struct alignas(64) Seat {
  FutexWord state;
  std::atomic<int32_t> pid;  ///< set from 0 by its thread: old content is not read
  int32_t tid;               ///< of another thread before
  uint32_t rank;             ///< order of the program in the run
  uint32_t ordinal;          ///< order of the thread in its process
  uint32_t process;          ///< slot of the process whose wake word also ends the wait
  uint32_t word;
  uint32_t seen;  ///< epoch of that word
  int64_t due_ns;
  Step next;  ///< unless `none`, the model decides when the wait is over
  uint64_t subject;

  void vacate() noexcept {
    state.store(seat_free, std::memory_order_relaxed);
    pid.store(0, std::memory_order_release);
  }
};
static_assert(sizeof(Seat) == 64 && std::is_standard_layout_v<Seat>);

struct Page {
  uint64_t magic;
  std::atomic<int64_t> now_ns;
  FutexWord changes;                ///< raised whenever a seat begins to wait or is freed
  FutexWord is_over;                ///< time runs at the pace of the wall clock from here on
  std::atomic<int64_t> over_at_ns;  ///< CLOCK_MONOTONIC
  std::atomic<uint32_t> seat_count;
  std::atomic<int32_t> seatless;  ///< process whose thread has found no free seat; 0: none
  int32_t timekeeper;
  /// Virtual nanoseconds per nanosecond of CPU time; 0: callbacks take no time.
  double factor;
  uint32_t is_modelled;  ///< callbacks take the time that the platform model predicts
  /// By slot: incarnation of the subscription whose messages are all under way on the platform.
  std::atomic<uint32_t> under_way[subscription_capacity];
  alignas(64) Seat seats[seat_capacity];

  /// Lets time run at the pace of the wall clock, from the first call on.
  void end() noexcept {
    int64_t running = 0;
    over_at_ns.compare_exchange_strong(running, monotonic_ns(), std::memory_order_relaxed);
    is_over.store(1, std::memory_order_seq_cst);
  }
};
static_assert(std::atomic<int64_t>::is_always_lock_free);

}  // namespace manycore::virtual_time
