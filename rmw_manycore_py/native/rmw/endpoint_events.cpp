// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/endpoint_events.hpp"

#include <utility>

namespace rmw_manycore {
namespace {

rmw_qos_policy_kind_t kind_of(manycore::QosPolicy policy) noexcept {
  switch (policy) {
    case manycore::QosPolicy::durability:
      return RMW_QOS_POLICY_DURABILITY;
    case manycore::QosPolicy::deadline:
      return RMW_QOS_POLICY_DEADLINE;
    case manycore::QosPolicy::liveliness:
      return RMW_QOS_POLICY_LIVELINESS;
    case manycore::QosPolicy::reliability:
      return RMW_QOS_POLICY_RELIABILITY;
    case manycore::QosPolicy::none:
      break;
  }
  return RMW_QOS_POLICY_INVALID;
}

int32_t change(uint64_t now, uint64_t before) noexcept {
  return static_cast<int32_t>(now - before);
}

}  // namespace

bool EndpointEvents::supports(rmw_event_type_t type) noexcept {
  switch (type) {
    case RMW_EVENT_LIVELINESS_CHANGED:
    case RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE:
    case RMW_EVENT_MESSAGE_LOST:
    case RMW_EVENT_SUBSCRIPTION_MATCHED:
    case RMW_EVENT_OFFERED_QOS_INCOMPATIBLE:
    case RMW_EVENT_PUBLICATION_MATCHED:
      return true;
    default:
      return false;
  }
}

EventCounts EndpointEvents::counts(rmw_event_type_t type) const {
  switch (type) {
    case RMW_EVENT_LIVELINESS_CHANGED:
    case RMW_EVENT_SUBSCRIPTION_MATCHED:
    case RMW_EVENT_PUBLICATION_MATCHED: {
      const manycore::MatchedCount count = matched();
      return {count.total, count.current};
    }
    case RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE:
    case RMW_EVENT_OFFERED_QOS_INCOMPATIBLE: {
      const uint64_t total = incompatible().total;
      return {total, total};
    }
    case RMW_EVENT_MESSAGE_LOST: {
      const uint64_t total = lost();
      return {total, total};
    }
    default:
      return {};
  }
}

void EndpointEvents::take(rmw_event_type_t type, void * status) {
  const std::lock_guard lock(mutex_);
  const EventCounts now = counts(type);
  const EventCounts told = std::exchange(told_[type], now);
  told_changes_[type].store(now.changes(), std::memory_order_relaxed);
  switch (type) {
    case RMW_EVENT_SUBSCRIPTION_MATCHED:
    case RMW_EVENT_PUBLICATION_MATCHED:
      *static_cast<rmw_matched_status_t *>(status) = {
        now.total, now.total - told.total, now.current, change(now.current, told.current)};
      break;
    case RMW_EVENT_LIVELINESS_CHANGED:
      // Liveliness is automatic, without a lease: who is matched is alive, the dead are unmatched.
      *static_cast<rmw_liveliness_changed_status_t *>(status) = {
        change(now.current, 0), 0, change(now.current, told.current), 0};
      break;
    case RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE:
    case RMW_EVENT_OFFERED_QOS_INCOMPATIBLE:
      *static_cast<rmw_qos_incompatible_event_status_t *>(status) = {
        change(now.total, 0), change(now.total, told.total), kind_of(incompatible().last_policy)};
      break;
    case RMW_EVENT_MESSAGE_LOST:
      *static_cast<rmw_message_lost_status_t *>(status) = {now.total, now.total - told.total};
      break;
    default:
      break;
  }
}

void EndpointEvents::set_callback(
  rmw_event_type_t type, rmw_event_callback_t function, const void * user_data) {
  callback(type).set(function, user_data);
}

Callback & EndpointEvents::callback(rmw_event_type_t type) {
  const std::lock_guard lock(mutex_);
  if (!callbacks_[type]) {
    callbacks_[type] = std::make_unique<Callback>(
      thread_, [this, type] { return counts(type).changes(); },
      [this, type] { return untold(type); });
  }
  return *callbacks_[type];
}

void EndpointEvents::clear_callbacks() noexcept {
  for (auto & callback : callbacks_) {
    callback.reset();
  }
}

}  // namespace rmw_manycore
