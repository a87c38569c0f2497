// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/subscription.hpp"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/names.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/qos/qos.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/endpoint_spec.hpp"
#include "rmw/topics/network_flow.hpp"
#include "rmw/topics/qos_best_available.hpp"

namespace rmw_manycore {
namespace {

manycore::EndpointSpec spec_of(
  const Node & node, const MessageType & type, const char * topic,
  const rmw_qos_profile_t & profile, bool ignore_local) {
  manycore::EndpointSpec spec = endpoint_spec(
    node, manycore::EndpointRole::topic, topic, type, profile,
    manycore::EndpointKind::subscription);
  spec.ignore_local = ignore_local;
  return spec;
}

}  // namespace

Subscription::Subscription(
  const Node & node, const MessageType & type, const char * topic,
  const rmw_qos_profile_t & profile, const rmw_subscription_options_t & options)
: EndpointEvents(node.callback_thread()),
  process_(node.shared_process()),
  topic_(topic),
  cdr_(type.cdr),
  loans_(cdr_.plain_bytes()),
  inbox_(
    node.process().create_subscription(
      spec_of(node, type, topic, profile, options.ignore_local_publications)),
    MessageTopic(manycore::EndpointRole::topic, topic_), node.callback_thread()) {
  handle.implementation_identifier = identifier;
  handle.data = this;
  handle.topic_name = topic_.c_str();
  handle.options = options;
  handle.can_loan_messages = loans_.lends() && transport().transfer() == manycore::Transfer::dsm;
  handle.is_cft_enabled = false;
}

EventCounts Subscription::counts(rmw_event_type_t type) const {
  switch (type) {
    case RMW_EVENT_LIVELINESS_CHANGED:
      return liveliness_changes_.observe(transport().liveliness());
    case RMW_EVENT_REQUESTED_DEADLINE_MISSED:
      return EventCounts::of(transport().deadline_missed());
    case RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE:
      return EventCounts::of(transport().incompatible());
    case RMW_EVENT_MESSAGE_LOST:
      return EventCounts::of(transport().lost());
    case RMW_EVENT_SUBSCRIPTION_INCOMPATIBLE_TYPE:
      return EventCounts::of(transport().incompatible_types());
    case RMW_EVENT_SUBSCRIPTION_MATCHED:
      return EventCounts::of(transport().matched());
    default:
      return {};
  }
}

}  // namespace rmw_manycore

using rmw_manycore::Subscription;

rmw_subscription_t * rmw_create_subscription(
  const rmw_node_t * node, const rosidl_message_type_support_t * type_support,
  const char * topic_name, const rmw_qos_profile_t * qos_policies,
  const rmw_subscription_options_t * subscription_options) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(node);
  RMW_CHECK_ARGUMENT_FOR_NULL(type_support, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(topic_name, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(qos_policies, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(subscription_options, nullptr);

  // Implementation
  return rmw_manycore::guarded_handle([&] {
    rmw_manycore::check_endpoint_name(topic_name, *qos_policies);
    rmw_manycore::check_network_flow(subscription_options->require_unique_network_flow_endpoints);
    const auto & owner = rmw_manycore::Node::of(node);
    const rmw_qos_profile_t profile =
      rmw_manycore::best_available_for_subscription(owner, topic_name, *qos_policies);
    const auto type = rmw_manycore::MessageType::of(type_support);
    auto & made = *new Subscription(owner, type, topic_name, profile, *subscription_options);
    if (const auto init = rmw_manycore::tracepoints().subscription_init) {
      init(&made.handle, made.transport().gid().data());
    }
    return &made.handle;
  });
}

rmw_ret_t rmw_destroy_subscription(rmw_node_t * node, rmw_subscription_t * subscription) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_HANDLE(subscription);

  // Implementation
  delete &Subscription::of(subscription);
  return RMW_RET_OK;
}

rmw_ret_t rmw_subscription_count_matched_publishers(
  const rmw_subscription_t * subscription, size_t * publisher_count) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(publisher_count);

  // Implementation
  return rmw_manycore::guarded([&] {
    *publisher_count = Subscription::of(subscription).transport().matched().current;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_subscription_get_actual_qos(
  const rmw_subscription_t * subscription, rmw_qos_profile_t * qos) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(qos);

  // Implementation
  *qos = rmw_manycore::to_rmw(Subscription::of(subscription).transport().qos());
  return RMW_RET_OK;
}
