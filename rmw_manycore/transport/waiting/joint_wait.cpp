// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/waiting/joint_wait.hpp"

#include <algorithm>

#include "platform/futex_any.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {
namespace {

/// Counts this thread as a sleeper on each platform; see WakeWord::notify() for why no wake-up is
/// lost.
class CountedSleeper {
public:
  explicit CountedSleeper(const std::vector<std::atomic<uint32_t> *> & counts) noexcept
  : counts_(counts) {
    for (std::atomic<uint32_t> * const count : counts_) {
      count->fetch_add(1, std::memory_order_seq_cst);
    }
  }
  ~CountedSleeper() {
    for (std::atomic<uint32_t> * const count : counts_) {
      count->fetch_sub(1, std::memory_order_relaxed);
    }
  }
  CountedSleeper(const CountedSleeper &) = delete;
  CountedSleeper & operator=(const CountedSleeper &) = delete;

private:
  const std::vector<std::atomic<uint32_t> *> & counts_;
};

bool any_moved(const std::vector<SeenEpoch> & seen) noexcept {
  return std::any_of(seen.begin(), seen.end(), [](const SeenEpoch & place) {
    return place.waiter->epoch() != place.epoch;
  });
}

/// Waits while time is virtual.
void pass_virtually(const std::vector<SeenEpoch> & seen, std::optional<int64_t> deadline_ns) {
  const virtual_time::Door * const door = virtual_time::door();
  while (door != nullptr && !any_moved(seen) && (!deadline_ns || door->now_ns() < *deadline_ns)) {
    if (!door->yield(true)) {
      return;
    }
  }
}

}  // namespace

bool wait_for_any(const std::vector<SeenEpoch> & seen, std::optional<int64_t> deadline_ns) {
  std::vector<std::atomic<uint32_t> *> counts;
  std::vector<AwaitedWord> awaited;
  for (const SeenEpoch & place : seen) {
    counts.push_back(&place.waiter->sleepers_);
    counts.push_back(&place.waiter->word_.sleepers);
    awaited.emplace_back(place.waiter->word_.epoch, place.epoch);
  }
  const CountedSleeper sleeper(counts);
  pass_virtually(seen, deadline_ns);
  if (deadline_ns) {
    deadline_ns = kernel_time_of(*deadline_ns);
  }
  while (!any_moved(seen) && (!deadline_ns || monotonic_ns() < *deadline_ns)) {
    futex_wait_any(awaited, deadline_ns);
  }
  return any_moved(seen);
}

}  // namespace manycore
