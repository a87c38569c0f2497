// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "rmw/event.h"
#include "rmw/events/callback.hpp"
#include "rmw/events/callback_thread.hpp"
#include "rmw/events/event_counts.hpp"
#include "rmw/events/event_types.hpp"

namespace rmw_manycore {

/// The events of one publisher or subscription. The transport counts occurrences; this class
/// remembers which were reported to the user. `rmw_event_t::data` points to it. Thread-safe.
class EndpointEvents {
public:
  explicit EndpointEvents(CallbackThread & thread) noexcept : thread_(thread) {}
  virtual ~EndpointEvents() = default;
  EndpointEvents(const EndpointEvents &) = delete;
  EndpointEvents & operator=(const EndpointEvents &) = delete;

  manycore::Waiters & waiters() const noexcept { return thread_.waiters(); }
  /// There are changes to take, for all of which the callback has been called: as with other
  /// middlewares, a wait reports an event after its callback.
  bool ready(rmw_event_type_t type) const;
  /// When the passage of time alone may make the event ready (CLOCK_MONOTONIC).
  int64_t next_due_ns(rmw_event_type_t type) const { return counts(type).next_due_ns; }
  /// Writes the status structure of `type` to `status` and marks its changes as reported.
  void take(rmw_event_type_t type, void * status);
  void set_callback(rmw_event_type_t type, rmw_event_callback_t function, const void * user_data);

protected:
  /// Counts of the endpoint for events of `type`. Must be thread-safe.
  virtual EventCounts counts(rmw_event_type_t type) const = 0;
  /// Callbacks use the derived class, so its destructor must call this.
  void clear_callbacks() noexcept;

private:
  uint64_t untold(rmw_event_type_t type) const {
    return counts(type).changes - told_changes_[type].load(std::memory_order_relaxed);
  }
  Callback & callback(rmw_event_type_t type);

  CallbackThread & thread_;
  mutable std::mutex mutex_;  ///< guards told_ and callbacks_; never held while user code runs
  std::array<EventCounts, event_type_slots> told_;
  std::array<std::atomic<uint64_t>, event_type_slots> told_changes_{};
  std::array<std::unique_ptr<Callback>, event_type_slots> callbacks_;
};

}  // namespace rmw_manycore
