// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <mutex>
#include <unordered_set>

#include "platform/fork_side.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/waiting/waiter.hpp"

namespace manycore {

/// Where the threads of this process sleep: each on a wake word of its own, so that a message wakes
/// only those that wait for it. Thread-safe.
class Waiters {
public:
  Waiters(WakeWords & words, WaitMode mode);
  Waiters(const Waiters &) = delete;
  Waiters & operator=(const Waiters &) = delete;

  /// For what arrives at subscriptions whose watchers were not set.
  Waiter & common() noexcept { return waiters_.front(); }
  /// Shared by some once more than `thread_numbers` threads wait.
  Waiter & of_this_thread() noexcept { return waiters_[word_of_this_thread()]; }
  /// To be added to the Watchers of all that this thread waits for.
  static uint32_t word_of_this_thread() noexcept;

  Watchers & graph_watchers() noexcept { return words_.graph; }
  Watchers & event_watchers() noexcept { return words_.endpoint_events; }

  void notify(const Watchers & watchers) noexcept;
  void notify_all() noexcept;

  /// To be called when this thread was woken for nothing: what it waited for earlier wakes it no
  /// more. What it waits for now has to be watched again.
  void forget_this_thread() noexcept;

private:
  friend class Watched;

  WakeWords & words_;
  /// In a child of fork() the mutex may be locked for ever.
  const ForkSide side_;
  std::deque<Waiter> waiters_;  ///< one per word
  std::mutex mutex_;            ///< of watched_
  std::unordered_set<Watchers *> watched_;
};

/// Watchers that forget_this_thread() knows of.
class Watched {
public:
  Watched(Waiters & waiters, Watchers & watchers);
  ~Watched();
  Watched(const Watched &) = delete;
  Watched & operator=(const Watched &) = delete;

  Waiters & waiters() const noexcept { return waiters_; }
  Watchers & watchers() const noexcept { return watchers_; }

private:
  Waiters & waiters_;
  Watchers & watchers_;
};

}  // namespace manycore
