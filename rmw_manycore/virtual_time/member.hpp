// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "platform/shared_memory.hpp"
#include "virtual_time/seats.hpp"

namespace manycore::virtual_time {

/// This process in the time of a run. Thread-safe; lives until the process ends.
class Member {
public:
  /// Nullptr in a process that no run in virtual time has started.
  static Member * find() noexcept;

  int64_t now_ns() const noexcept;
  /// False before join(), and in a child of fork(): such a process lives in wall time.
  bool has_joined() const noexcept { return has_joined_.load(std::memory_order_acquire); }
  void join() noexcept;
  void leave() noexcept { has_joined_.store(false, std::memory_order_relaxed); }
  /// Whether time goes on at the pace of the wall clock.
  bool is_over() const noexcept { return page_.is_over.load(std::memory_order_seq_cst) != 0; }

  /// Whether the calling thread has asked for the time, or waited, before.
  static bool is_asked_by_this_thread() noexcept;
  bool wait(const Awaited & awaited, int64_t due_ns) noexcept;
  /// False if time stopped being virtual before `due_ns`.
  bool sleep_until(int64_t due_ns) noexcept;
  bool yield(bool empty) noexcept;
  void end_turn(bool empty) noexcept;
  bool elapse(Step next, uint64_t subject) noexcept;
  bool has_arrived(uint32_t slot, uint32_t incarnation) const noexcept;

private:
  Member(SharedMemory memory, uint32_t rank) noexcept;
  static Member * attach() noexcept;
  Seat * seat_of_this_thread() noexcept;
  Seat * take_seat() noexcept;
  bool wait_in(Seat & seat) noexcept;
  bool elapse_by_factor() noexcept;
  void end_if_alone() noexcept;

  const SharedMemory memory_;
  Page & page_;
  const uint32_t rank_;
  std::atomic<bool> has_joined_{false};
  std::atomic<uint32_t> next_ordinal_{0};
};

}  // namespace manycore::virtual_time
