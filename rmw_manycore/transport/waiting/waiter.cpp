// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/waiting/waiter.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "platform/cpu.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {
namespace {

/// Twice the cost of waking a process on another CPU of a virtual machine (about 20 us): spinning
/// longer for a message gains nothing.
constexpr int64_t spin_budget_ns = 50'000;

/// The score counts recent waits in which spinning succeeded, or would have.
constexpr uint32_t score_limit = 16;
constexpr uint32_t score_of_success = 4;

/// Epoch loads between two reads of the clock.
constexpr int looks_per_check = 64;

}  // namespace

Waiter::Waiter(WakeWord & word, WaitMode mode, uint32_t process, uint32_t number) noexcept
: word_(word), mode_(mode), process_(process), number_(number), spin_score_(score_of_success) {}

uint32_t Waiter::epoch() const noexcept { return word_.epoch.load(std::memory_order_seq_cst); }

bool Waiter::spin(uint32_t seen, std::optional<int64_t> deadline_ns) noexcept {
  while (!deadline_ns || monotonic_ns() < *deadline_ns) {
    for (int i = 0; i < looks_per_check; ++i) {
      if (word_.epoch.load(std::memory_order_acquire) != seen) {
        return true;
      }
      pause_cpu();
    }
    // The receive thread that forwards the message may need this CPU.
    yield_cpu();
  }
  return epoch() != seen;
}

void Waiter::learn(bool served) noexcept {
  const uint32_t score = spin_score_.load(std::memory_order_relaxed);
  spin_score_.store(
    served ? std::min(score + score_of_success, score_limit) : score - (score != 0 ? 1 : 0),
    std::memory_order_relaxed);
}

bool Waiter::sleep(uint32_t seen, std::optional<int64_t> deadline_ns, OnSignal on_signal) noexcept {
  sleepers_.fetch_add(1, std::memory_order_seq_cst);
  word_.sleepers.fetch_add(1, std::memory_order_seq_cst);
  while (epoch() == seen && (!deadline_ns || monotonic_ns() < *deadline_ns)) {
    if (futex_wait(word_.epoch, seen, deadline_ns) && on_signal == OnSignal::give_up) {
      break;
    }
  }
  word_.sleepers.fetch_sub(1, std::memory_order_relaxed);
  sleepers_.fetch_sub(1, std::memory_order_relaxed);
  return epoch() != seen;
}

/// After the end of virtual time the rest passes at the pace of the wall clock.
bool Waiter::wait_virtually(
  const virtual_time::Door & door, uint32_t seen, std::optional<int64_t> deadline_ns,
  OnSignal on_signal) noexcept {
  const virtual_time::Awaited awaited{process_, number_, seen};
  while (epoch() == seen && (!deadline_ns || door.now_ns() < *deadline_ns)) {
    if (!door.wait(awaited, deadline_ns.value_or(INT64_MAX))) {
      if (deadline_ns) {
        deadline_ns = kernel_time_of(*deadline_ns);
      }
      return sleep(seen, deadline_ns, on_signal);
    }
  }
  return epoch() != seen;
}

bool Waiter::wait(uint32_t seen, std::optional<int64_t> deadline_ns, OnSignal on_signal) noexcept {
  if (const virtual_time::Door * const door = virtual_time::door()) {
    return wait_virtually(*door, seen, deadline_ns, on_signal);
  }
  if (mode_ == WaitMode::spin) {
    return spin(seen, deadline_ns);
  }
  if (mode_ == WaitMode::block) {
    return sleep(seen, deadline_ns, on_signal);
  }
  const int64_t start = monotonic_ns();
  const int64_t spin_end = start + spin_budget_ns;
  if (spin_score_.load(std::memory_order_relaxed) != 0) {
    if (spin(seen, deadline_ns ? std::min(*deadline_ns, spin_end) : spin_end)) {
      learn(true);
      return true;
    }
    learn(false);
    return sleep(seen, deadline_ns, on_signal);
  }
  const bool woken = sleep(seen, deadline_ns, on_signal);
  if (woken && monotonic_ns() < spin_end) {
    learn(true);  // spinning would have caught this message
  }
  return woken;
}

/// Sleepers of this process are also counted in its private memory: shutdown must wake them even if
/// the count in shared memory is damaged.
void Waiter::notify() noexcept {
  word_.notify();
  if (sleepers_.load(std::memory_order_seq_cst) != 0) {
    futex_wake_all(word_.epoch);
  }
}

}  // namespace manycore
