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
  /// Returns when the passage of time may raise a count next.
  std::optional<int64_t> report_all() noexcept;
  void wake_sleep() noexcept;
  void watch_all(uint32_t word) noexcept;

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
  struct Arrivals {
    uint64_t count;                               ///< since creation
    int64_t next_due_ns = manycore::infinite_ns;  ///< when time may raise it; CLOCK_MONOTONIC
  };

  /// `watchers` are notified when the count of `arrivals` rises. `unread` is how many of these are
  /// not taken yet.
  Callback(
    CallbackThread & thread, manycore::Watchers & watchers, std::function<Arrivals()> arrivals,
    std::function<uint64_t()> unread)
  : thread_(thread),
    watchers_(watchers),
    arrivals_(std::move(arrivals)),
    unread_(std::move(unread)) {}
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
  /// Returns when the passage of time may raise the count next.
  int64_t report() noexcept;

  CallbackThread & thread_;
  manycore::Watchers & watchers_;
  const std::function<Arrivals()> arrivals_;
  const std::function<uint64_t()> unread_;
  rmw_event_callback_t function_ = nullptr;
  const void * user_data_ = nullptr;
  uint64_t reported_ = 0;
};

}  // namespace rmw_manycore
