// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <unordered_set>

#include "platform/fork_side.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/waiting/waiter.hpp"

namespace manycore {

/// The waiters of this process: one wake word per thread, so that a message wakes only the threads
/// that wait for it. Thread-safe.
class Waiters {
public:
  /// The waiters of the process in slot `process`, whose wake words are `words`.
  Waiters(GraphWatchers & graph_watchers, uint32_t process, WakeWords & words, WaitMode mode);
  Waiters(const Waiters &) = delete;
  Waiters & operator=(const Waiters &) = delete;

  /// For arrivals at subscriptions whose watchers were not changed.
  Waiter & common() noexcept { return waiters_.front(); }
  /// Shared by several threads once more than `unique_thread_numbers` threads wait.
  Waiter & of_this_thread() noexcept { return waiters_[word_of_this_thread()]; }
  /// Word to add to the Watchers of everything that this thread waits for.
  static uint32_t word_of_this_thread() noexcept;

  /// Reserves `callback_word` for one thread; false if it is reserved. The thread may end before
  /// give_back_callback_word().
  bool take_callback_word() noexcept { return !is_callback_word_taken_.exchange(true); }
  void give_back_callback_word() noexcept { is_callback_word_taken_ = false; }
  Waiter & of_word(uint32_t word) noexcept { return waiters_[word]; }
  /// What the thread on `callback_word` has to look at.
  CallbackMarks & callback_marks() noexcept { return words_.marks; }

  /// Wakes `word` at each change of the graph.
  void watch_graph(uint32_t word) noexcept;
  Watchers & event_watchers() noexcept { return words_.endpoint_events; }

  void notify(const Watchers & watchers) noexcept;
  void notify_all() noexcept;

  /// Call when this thread was woken for nothing: removes its word from all watchers, so that
  /// former waits wake it no more. Add the word again to what it waits for now. No effect if the
  /// thread shares its word.
  void forget_this_thread() noexcept;

private:
  friend class Watched;

  GraphWatchers & graph_watchers_;
  const uint32_t process_;  ///< slot
  WakeWords & words_;
  /// In a child of fork() the mutex may be locked forever.
  const ForkSide side_;
  std::deque<Waiter> waiters_;  ///< one per word
  std::atomic<bool> is_callback_word_taken_{false};
  std::mutex mutex_;  ///< guards watched_
  std::unordered_set<Watchers *> watched_;
};

/// Registers Watchers for forget_this_thread() during its lifetime.
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
