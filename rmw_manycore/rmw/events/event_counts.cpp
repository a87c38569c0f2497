// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/event_counts.hpp"

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

template<typename Status>
void fill_total(const EventCounts & now, const EventCounts & told, void * status) {
  *static_cast<Status *>(status) = {change(now.total, 0), change(now.total, told.total)};
}

}  // namespace

void fill_status(
  rmw_event_type_t type, const EventCounts & now, const EventCounts & told, void * status) {
  switch (type) {
    case RMW_EVENT_SUBSCRIPTION_MATCHED:
    case RMW_EVENT_PUBLICATION_MATCHED:
      *static_cast<rmw_matched_status_t *>(status) = {
        now.total, now.total - told.total, now.current, change(now.current, told.current)};
      break;
    case RMW_EVENT_LIVELINESS_CHANGED:
      *static_cast<rmw_liveliness_changed_status_t *>(status) = {
        change(now.current, 0), change(now.not_alive, 0), change(now.current, told.current),
        change(now.not_alive, told.not_alive)};
      break;
    case RMW_EVENT_REQUESTED_DEADLINE_MISSED:
      fill_total<rmw_requested_deadline_missed_status_t>(now, told, status);
      break;
    case RMW_EVENT_OFFERED_DEADLINE_MISSED:
      fill_total<rmw_offered_deadline_missed_status_t>(now, told, status);
      break;
    case RMW_EVENT_LIVELINESS_LOST:
      fill_total<rmw_liveliness_lost_status_t>(now, told, status);
      break;
    case RMW_EVENT_SUBSCRIPTION_INCOMPATIBLE_TYPE:
    case RMW_EVENT_PUBLISHER_INCOMPATIBLE_TYPE:
      fill_total<rmw_incompatible_type_status_t>(now, told, status);
      break;
    case RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE:
    case RMW_EVENT_OFFERED_QOS_INCOMPATIBLE:
      *static_cast<rmw_qos_incompatible_event_status_t *>(status) = {
        change(now.total, 0), change(now.total, told.total), kind_of(now.last_policy)};
      break;
    case RMW_EVENT_MESSAGE_LOST:
      *static_cast<rmw_message_lost_status_t *>(status) = {now.total, now.total - told.total};
      break;
    default:
      break;
  }
}

}  // namespace rmw_manycore
