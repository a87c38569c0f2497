// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace manycore {

struct SeenEpoch;
struct WakeWord;

/// How a process waits for its next notification.
enum class WaitMode : uint8_t {
  block,     ///< sleeps at once
  adaptive,  ///< spins for a learned, bounded time, then sleeps
  spin,      ///< never sleeps; for cores that belong to one node alone
};

/// Where threads sleep: on one wake word. Every notification (message, guard condition, graph
/// change while watched) raises the epoch. Use: have the word among the Watchers of all entities,
/// read epoch(), look at all entities, then wait(epoch).
class Waiter {
public:
  Waiter(WakeWord & word, WaitMode mode) noexcept;

  uint32_t epoch() const noexcept;

  /// Returns true when the epoch is no longer `seen`, false at `deadline_ns` (CLOCK_MONOTONIC;
  /// unset = no limit). Any number of threads.
  bool wait(uint32_t seen, std::optional<int64_t> deadline_ns) noexcept;

  /// Raises the epoch and wakes this process's sleepers (guard conditions).
  void notify() noexcept;

private:
  friend bool wait_for_any(const std::vector<SeenEpoch> &, std::optional<int64_t>);
  bool spin(uint32_t seen, std::optional<int64_t> deadline_ns) noexcept;
  bool sleep(uint32_t seen, std::optional<int64_t> deadline_ns) noexcept;
  void learn(bool served) noexcept;

  WakeWord & word_;
  WaitMode mode_;
  std::atomic<uint32_t> spin_score_;
  std::atomic<uint32_t> sleepers_{0};  ///< threads of this process
};

}  // namespace manycore
