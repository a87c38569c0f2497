// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/services/client.hpp"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/names.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/qos/qos.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/endpoint_spec.hpp"
#include "rmw/topics/qos_best_available.hpp"

namespace rmw_manycore {

using manycore::EndpointKind;
using manycore::EndpointRole;

Client::Client(
  const Node & node, ServiceType type, const char * name, const rmw_qos_profile_t & profile)
: name_(name),
  type_(std::move(type)),
  replies_(
    node.process().create_subscription(
      endpoint_spec(node, EndpointRole::reply, name, type_, profile, EndpointKind::subscription)),
    MessageTopic(EndpointRole::reply, name_), node.callback_thread()),
  requests_(
    node.process().create_publisher(
      endpoint_spec(node, EndpointRole::request, name, type_, profile, EndpointKind::publisher)),
    MessageTopic(EndpointRole::request, name_), node.callback_thread()) {
  handle.implementation_identifier = identifier;
  handle.data = this;
  handle.service_name = name_.c_str();
}

}  // namespace rmw_manycore

using rmw_manycore::Client;

rmw_client_t * rmw_create_client(
  const rmw_node_t * node, const rosidl_service_type_support_t * type_support,
  const char * service_name, const rmw_qos_profile_t * qos_policies) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(node);
  RMW_CHECK_ARGUMENT_FOR_NULL(type_support, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(service_name, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(qos_policies, nullptr);

  // Implementation
  return rmw_manycore::guarded_handle([&] {
    rmw_manycore::check_endpoint_name(service_name, *qos_policies);
    auto type = rmw_manycore::ServiceType::of(type_support);
    auto & made = *new Client(
      rmw_manycore::Node::of(node), std::move(type), service_name,
      rmw_manycore::best_available_for_service(*qos_policies));
    if (const auto init = rmw_manycore::tracepoints().client_init) {
      init(&made.handle, made.gid().data());
    }
    return &made.handle;
  });
}

rmw_ret_t rmw_destroy_client(rmw_node_t * node, rmw_client_t * client) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_HANDLE(client);

  // Implementation
  delete &Client::of(client);
  return RMW_RET_OK;
}

rmw_ret_t rmw_client_request_publisher_get_actual_qos(
  const rmw_client_t * client, rmw_qos_profile_t * qos) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);
  MANYCORE_CHECK_ARGUMENT(qos);

  // Implementation
  *qos = rmw_manycore::to_rmw(Client::of(client).requests().transport().qos());
  return RMW_RET_OK;
}

rmw_ret_t rmw_client_response_subscription_get_actual_qos(
  const rmw_client_t * client, rmw_qos_profile_t * qos) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);
  MANYCORE_CHECK_ARGUMENT(qos);

  // Implementation
  *qos = rmw_manycore::to_rmw(Client::of(client).replies().transport().qos());
  return RMW_RET_OK;
}
