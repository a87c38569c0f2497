// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "virtual_time/door.hpp"

namespace manycore {

struct SeenEpoch;
struct WakeWord;

/// How a process waits for notifications.
enum class WaitMode : uint8_t {
  block,     ///< sleeps at once
  adaptive,  ///< spins for a learned, bounded time, then sleeps
  spin,      ///< never sleeps; for cores reserved for a single node
};

/// What a sleep does after a signal handler ran.
enum class OnSignal : uint8_t {
  resume,
  give_up,  ///< for callers whose handlers only record the signal, as Python's do
};

/// Waiter that blocked threads sleep on, backed by one wake word. Each notification (message, guard
/// condition, watched graph change) increments the epoch. Usage: add the word to the Watchers of
/// all entities, read epoch(), check all entities, then wait(epoch).
class Waiter {
public:
  /// `number`: of the word in slot `process`, for the timekeeper of a run in virtual time.
  Waiter(
    WakeWord & word, WaitMode mode, uint32_t process = virtual_time::no_process,
    uint32_t number = 0) noexcept;

  uint32_t epoch() const noexcept;

  /// Returns true when the epoch is no longer `seen`, false at `deadline_ns` (qos_now_ns();
  /// unset = no limit) or after it gave up on a signal, which spinning ignores. Thread-safe.
  bool wait(
    uint32_t seen, std::optional<int64_t> deadline_ns,
    OnSignal on_signal = OnSignal::resume) noexcept;

  /// Increments the epoch and wakes the sleepers of this process (guard conditions).
  void notify() noexcept;

private:
  friend bool wait_for_any(const std::vector<SeenEpoch> &, std::optional<int64_t>);
  bool spin(uint32_t seen, std::optional<int64_t> deadline_ns) noexcept;
  bool wait_virtually(
    const virtual_time::Door & door, uint32_t seen, std::optional<int64_t> deadline_ns,
    OnSignal on_signal) noexcept;
  bool sleep(uint32_t seen, std::optional<int64_t> deadline_ns, OnSignal on_signal) noexcept;
  void learn(bool served) noexcept;

  WakeWord & word_;
  WaitMode mode_;
  const uint32_t process_;
  const uint32_t number_;
  std::atomic<uint32_t> spin_score_;
  std::atomic<uint32_t> sleepers_{0};  ///< threads of this process
};

}  // namespace manycore
