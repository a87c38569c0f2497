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

/// Calls the "on new message / request / response / event" callbacks of one context. Started when
/// the first callback is set; sleeps on its own wake word. Thread-safe.
class CallbackThread {
public:
  explicit CallbackThread(manycore::Waiters & waiters) noexcept : waiters_(waiters) {}
  ~CallbackThread() { stop(); }
  CallbackThread(const CallbackThread &) = delete;
  CallbackThread & operator=(const CallbackThread &) = delete;

  manycore::Waiters & waiters() const noexcept { return waiters_; }
  /// Stops the thread; no callback is called afterwards. Must not be called from a callback.
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
  /// In a child of fork() the thread does not exist, and the mutex may be locked forever.
  const manycore::ForkSide side_;
  /// Held while a callback runs, so that none runs after it was cleared. Recursive, because a
  /// callback may set or clear callbacks.
  std::recursive_mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<Callback *> active_;
  manycore::Waiter * sleeping_ = nullptr;  ///< the waiter of the thread while it runs
  bool changed_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

/// A settable callback: a count that only rises, and the function to call for each rise.
class Callback {
public:
  using Count = std::function<uint64_t()>;
  using Due = std::function<int64_t()>;
  static int64_t never() noexcept { return manycore::infinite_ns; }

  /// `watchers` are notified when `arrivals` rises. `arrivals` counts since creation; `unread` is
  /// how many of these are not taken yet. `next_due_ns` is when the passage of time may raise
  /// `arrivals` (CLOCK_MONOTONIC).
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

  /// Sets, replaces or (nullptr) clears the function. Earlier arrivals that are neither reported
  /// nor taken are reported at once, from the calling thread.
  void set(rmw_event_callback_t function, const void * user_data);
  /// Reports new arrivals from the calling thread if a function is set.
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
