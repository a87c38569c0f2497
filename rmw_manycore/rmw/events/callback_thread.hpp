// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "platform/fork_side.hpp"
#include "rmw/event_callback_type.h"
#include "transport/layout/qos.hpp"
#include "transport/waiting/waiters.hpp"

namespace rmw_manycore {

class Callback;

/// Calls the "on new message / request / response / event" callbacks of one context. It runs only
/// once a callback was set, sleeps on its own wake word, and touches nothing else. Thread-safe.
class CallbackThread {
public:
  explicit CallbackThread(manycore::Waiters & waiters) noexcept : waiters_(waiters) {}
  ~CallbackThread() { stop(); }
  CallbackThread(const CallbackThread &) = delete;
  CallbackThread & operator=(const CallbackThread &) = delete;

  manycore::Waiters & waiters() const noexcept { return waiters_; }
  /// After it no callback is called any more. Not from within a callback.
  void stop() noexcept;

private:
  friend class Callback;
  void add(Callback & callback);
  void remove(Callback & callback) noexcept;
  void run() noexcept;
  void report_all() noexcept;
  void wake_sleep() noexcept;
  void watch_all(uint32_t word) noexcept;
  std::optional<int64_t> next_due_ns() const;

  manycore::Waiters & waiters_;
  /// In a child of fork() there is no thread, and the mutex may be locked for ever.
  const manycore::ForkSide side_;
  /// Held while a callback runs, so that none runs after it was taken away; recursive, because a
  /// callback may set or clear callbacks.
  std::recursive_mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<Callback *> active_;
  manycore::Waiter * sleeping_ = nullptr;  ///< the thread's, once it runs
  bool changed_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

/// One settable callback: a count that only rises, and who hears of each rise.
class Callback {
public:
  using Count = std::function<uint64_t()>;
  using Due = std::function<int64_t()>;
  static int64_t never() noexcept { return manycore::infinite_ns; }

  /// `watchers` are those to be woken when `arrivals` rises. `arrivals` counts since creation;
  /// `unread` says how many of them still wait to be taken. `next_due_ns` says when time alone may
  /// raise `arrivals` (CLOCK_MONOTONIC).
  Callback(
    CallbackThread & thread, manycore::Watchers & watchers, Count arrivals, Count unread,
    Due next_due_ns = never)
  : thread_(thread),
    watchers_(watchers),
    arrivals_(std::move(arrivals)),
    unread_(std::move(unread)),
    next_due_ns_(std::move(next_due_ns)) {}
  ~Callback() { clear(); }
  Callback(const Callback &) = delete;
  Callback & operator=(const Callback &) = delete;

  /// Sets, replaces or (nullptr) clears. What arrived before and is neither reported nor taken is
  /// reported at once, from the calling thread.
  void set(rmw_event_callback_t function, const void * user_data);
  /// Reports from the calling thread what is not reported yet, if a function is set.
  void report_now();

private:
  friend class CallbackThread;
  void clear() noexcept;
  void report() noexcept;

  CallbackThread & thread_;
  manycore::Watchers & watchers_;
  const Count arrivals_;
  const Count unread_;
  const Due next_due_ns_;
  rmw_event_callback_t function_ = nullptr;
  const void * user_data_ = nullptr;
  uint64_t reported_ = 0;
};

}  // namespace rmw_manycore
