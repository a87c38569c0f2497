// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/endpoint_events.hpp"

#include <utility>

namespace rmw_manycore {

void EndpointEvents::take(rmw_event_type_t type, void * status) {
  const std::lock_guard lock(mutex_);
  const EventCounts now = counts(type);
  const EventCounts told = std::exchange(told_[type], now);
  told_changes_[type].store(now.changes, std::memory_order_relaxed);
  fill_status(type, now, told, status);
}

void EndpointEvents::set_callback(
  rmw_event_type_t type, rmw_event_callback_t function, const void * user_data) {
  callback(type).set(function, user_data);
}

void EndpointEvents::report(rmw_event_type_t type) {
  Callback * found = nullptr;
  {
    const std::lock_guard lock(mutex_);
    found = callbacks_[type].get();
  }
  if (found != nullptr) {
    found->report_now();
  }
}

Callback & EndpointEvents::callback(rmw_event_type_t type) {
  const std::lock_guard lock(mutex_);
  if (!callbacks_[type]) {
    callbacks_[type] = std::make_unique<Callback>(
      thread_, Reporter::Source{
                 thread_.waiters().event_watchers(),
                 [this, type] {
                   const EventCounts now = counts(type);
                   return Reporter::Arrivals{now.changes, now.next_due_ns};
                 },
                 [this, type] { return untold(type); }});
  }
  return *callbacks_[type];
}

void EndpointEvents::clear_callbacks() noexcept {
  for (auto & callback : callbacks_) {
    callback.reset();
  }
}

}  // namespace rmw_manycore
