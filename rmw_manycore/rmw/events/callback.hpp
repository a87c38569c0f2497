// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "rmw/event_callback_type.h"
#include "rmw/events/message_topic.hpp"
#include "transport/layout/qos.hpp"
#include "transport/layout/wake_words.hpp"

namespace rmw_manycore {

class CallbackThread;

/// A settable callback: a count that only rises, and the function to call for each rise.
class Callback {
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
  struct Source {
    manycore::Watchers & watchers;       ///< notified when the count rises
    std::function<Arrivals()> arrivals;  ///< thread-safe
    std::function<uint64_t()> unread;    ///< how many of them are not taken yet
    // Of messages, not of events:
    const MessageTopic * topic = nullptr;
    uint32_t endpoint = 0;              ///< slot of the subscription
    std::function<Known()> known = {};  ///< thread-safe
  };

  Callback(CallbackThread & thread, Source source) : thread_(thread), source_(std::move(source)) {}
  ~Callback() { clear(); }
  Callback(const Callback &) = delete;
  Callback & operator=(const Callback &) = delete;

  /// Sets, replaces or (nullptr) clears the function. Earlier arrivals that are neither reported
  /// nor taken are reported at once, from the calling thread; the function may destroy this object.
  /// No effect in a child of fork().
  void set(rmw_event_callback_t function, const void * user_data);
  /// Reports new arrivals from the calling thread if a function is set.
  void report_now();

private:
  friend class CallbackThread;
  void clear() noexcept;
  /// The function may destroy this object.
  void call(uint64_t arrivals);
  /// Returns when the passage of time may raise the count next.
  int64_t report();
  /// Never waits. False if more may have arrived.
  bool report_known();
  void report_up_to(uint64_t count);

  CallbackThread & thread_;
  const Source source_;
  rmw_event_callback_t function_ = nullptr;
  const void * user_data_ = nullptr;
  bool is_active_ = false;  ///< in the lists of the thread
  uint64_t reported_ = 0;
};

}  // namespace rmw_manycore
