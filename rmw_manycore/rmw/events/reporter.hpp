// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "rmw/event_callback_type.h"
#include "rmw/events/message_topic.hpp"
#include "transport/layout/qos.hpp"
#include "transport/layout/wake_words.hpp"

namespace rmw_manycore {

/// Calls a user's function for each rise of a count that only rises. A thread that looks at it
/// shares it with the Callback that owns it, and finds no function once that has gone.
class Reporter {
public:
  struct Arrivals {
    uint64_t count;                               ///< since creation
    int64_t next_due_ns = manycore::infinite_ns;  ///< when time may raise it; CLOCK_MONOTONIC
  };
  /// What is known without waiting for a thread that takes a message.
  struct Known {
    uint64_t count;
    bool is_all;
  };
  /// Only used while there is a function.
  struct Source {
    manycore::Watchers & watchers;       ///< notified when the count rises
    std::function<Arrivals()> arrivals;  ///< thread-safe
    std::function<uint64_t()> unread;    ///< how many of them are not taken yet
    // Of messages, not of events:
    std::optional<MessageTopic> topic = std::nullopt;
    uint32_t endpoint = 0;              ///< slot of the subscription
    std::function<Known()> known = {};  ///< thread-safe
    // Of events, which wake threads that wait for them when the function has been called:
    std::function<void()> notify_called = {};  ///< thread-safe; may outlive the entity
  };

  explicit Reporter(Source source) : source_(std::move(source)) {}
  Reporter(const Reporter &) = delete;
  Reporter & operator=(const Reporter &) = delete;

  const Source & source() const noexcept { return source_; }

  /// Held while the function runs, so that it does not run after it was cleared. Recursive, because
  /// the function may set or clear itself. A thread may lock it while it holds that of another
  /// Reporter, whose function it runs.
  std::recursive_mutex & mutex() noexcept { return mutex_; }

  // Require the mutex:

  /// Earlier arrivals that are neither reported nor taken are to be reported next.
  void set(rmw_event_callback_t function, const void * user_data);
  void clear() noexcept;
  /// Returns when the passage of time may raise the count next.
  int64_t report();
  /// Never waits. False if more may have arrived.
  bool report_known();

  /// Of events: for how many the function has returned, all of them if there is none. Needs no
  /// mutex.
  uint64_t called() const noexcept { return called_.load(std::memory_order_seq_cst); }

  /// True in a function that a Reporter calls.
  static bool is_calling() noexcept;

private:
  friend class CallbackThread;

  void report_up_to(uint64_t count);
  void call(uint64_t arrivals);
  void note_called(uint64_t count) noexcept;

  static constexpr uint64_t all = UINT64_MAX;
  const Source source_;
  std::recursive_mutex mutex_;
  rmw_event_callback_t function_ = nullptr;
  const void * user_data_ = nullptr;
  uint64_t reported_ = 0;
  std::atomic<uint64_t> called_{all};
  /// Position in the lists of the CallbackThread, 0: in none. Guarded by its mutex.
  uint64_t order_ = 0;
};

}  // namespace rmw_manycore
