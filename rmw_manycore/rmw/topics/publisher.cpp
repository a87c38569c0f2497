// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/publisher.hpp"

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

using manycore::EndpointKind;
using manycore::EndpointRole;

Publisher::Publisher(
  const Node & node, const MessageType & type, const char * topic,
  const rmw_qos_profile_t & profile, const rmw_publisher_options_t & options)
: EndpointEvents(node.callback_thread()),
  topic_(topic),
  cdr_(type.cdr),
  loans_(cdr_.plain_bytes()),
  outbox_(
    node.process().create_publisher(
      endpoint_spec(node, EndpointRole::topic, topic, type, profile, EndpointKind::publisher)),
    MessageTopic(EndpointRole::topic, topic_), node.callback_thread()) {
  handle.implementation_identifier = identifier;
  handle.data = this;
  handle.topic_name = topic_.c_str();
  handle.options = options;
  handle.can_loan_messages = loans_.lends() && transport().transfer() == manycore::Transfer::dsm;
}

EventCounts Publisher::counts(rmw_event_type_t type) const {
  switch (type) {
    case RMW_EVENT_LIVELINESS_LOST:
      return EventCounts::of(transport().liveliness_lost());
    case RMW_EVENT_OFFERED_DEADLINE_MISSED:
      return EventCounts::of(transport().deadline_missed());
    case RMW_EVENT_OFFERED_QOS_INCOMPATIBLE:
      return EventCounts::of(transport().incompatible());
    case RMW_EVENT_PUBLISHER_INCOMPATIBLE_TYPE:
      return EventCounts::of(transport().incompatible_types());
    case RMW_EVENT_PUBLICATION_MATCHED:
      return EventCounts::of(transport().matched());
    default:
      return {};
  }
}

}  // namespace rmw_manycore

using rmw_manycore::Publisher;

rmw_publisher_t * rmw_create_publisher(
  const rmw_node_t * node, const rosidl_message_type_support_t * type_support,
  const char * topic_name, const rmw_qos_profile_t * qos_profile,
  const rmw_publisher_options_t * publisher_options) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(node);
  RMW_CHECK_ARGUMENT_FOR_NULL(type_support, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(topic_name, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(qos_profile, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(publisher_options, nullptr);

  // Implementation
  return rmw_manycore::guarded_handle([&] {
    rmw_manycore::check_endpoint_name(topic_name, *qos_profile);
    rmw_manycore::check_network_flow(publisher_options->require_unique_network_flow_endpoints);
    const auto & owner = rmw_manycore::Node::of(node);
    const rmw_qos_profile_t profile =
      rmw_manycore::best_available_for_publisher(owner, topic_name, *qos_profile);
    const auto type = rmw_manycore::MessageType::of(type_support);
    auto & made = *new Publisher(owner, type, topic_name, profile, *publisher_options);
    if (const auto init = rmw_manycore::tracepoints().publisher_init) {
      init(&made.handle, made.transport().gid().data());
    }
    return &made.handle;
  });
}

rmw_ret_t rmw_destroy_publisher(rmw_node_t * node, rmw_publisher_t * publisher) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_HANDLE(publisher);

  // Implementation
  delete &Publisher::of(publisher);
  return RMW_RET_OK;
}

rmw_ret_t rmw_publisher_count_matched_subscriptions(
  const rmw_publisher_t * publisher, size_t * subscription_count) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);
  MANYCORE_CHECK_ARGUMENT(subscription_count);

  // Implementation
  return rmw_manycore::guarded([&] {
    *subscription_count = Publisher::of(publisher).transport().matched().current;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_publisher_get_actual_qos(const rmw_publisher_t * publisher, rmw_qos_profile_t * qos) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);
  MANYCORE_CHECK_ARGUMENT(qos);

  // Implementation
  *qos = rmw_manycore::to_rmw(Publisher::of(publisher).transport().qos());
  return RMW_RET_OK;
}

rmw_ret_t rmw_publisher_assert_liveliness(const rmw_publisher_t * publisher) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);

  // Implementation
  return rmw_manycore::guarded([&] {
    Publisher::of(publisher).transport().assert_liveliness();
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_publisher_wait_for_all_acked(
  const rmw_publisher_t * publisher, rmw_time_t /*wait_timeout*/) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);

  // Implementation: a message is acknowledged when it has reached the middleware of its readers,
  // taken or not. Here that is the case from publication on, whatever happens to the publisher.
  return RMW_RET_OK;
}
