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

bool EndpointEvents::ready(rmw_event_type_t type) const {
  const uint64_t changes = counts(type).changes;
  if (changes == told_changes_[type].load(std::memory_order_relaxed)) {
    return false;
  }
  const std::lock_guard lock(mutex_);
  const std::unique_ptr<Callback> & callback = callbacks_[type];
  return callback == nullptr || callback->has_called_for(changes);
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
                 [this, type] { return untold(type); },
                 std::nullopt,
                 0,
                 {},
                 [&waiters = thread_.waiters()] { waiters.notify(waiters.event_watchers()); }});
  }
  return *callbacks_[type];
}

void EndpointEvents::clear_callbacks() noexcept {
  for (auto & callback : callbacks_) {
    callback.reset();
  }
}

}  // namespace rmw_manycore
