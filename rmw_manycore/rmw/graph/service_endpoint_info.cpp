// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The clients and servers of a service; rmw has these functions since Lyrical.

#if __has_include("rmw/get_service_endpoint_info.h")

#include "rmw/get_service_endpoint_info.h"

#include <algorithm>
#include <array>

#include "rcpputils/scope_exit.hpp"
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/graph/endpoint_info.hpp"
#include "rmw/graph/topic_endpoints.hpp"
#include "rmw/qos/qos.hpp"
#include "rmw/service_endpoint_info_array.h"

namespace rmw_manycore {
namespace {

using manycore::EndpointInfo;
using manycore::EndpointKind;
using manycore::EndpointRole;

/// What a client or server consists of.
struct ServiceEndpoint {
  EndpointInfo reader;
  EndpointInfo writer;
};

struct Side {
  EndpointRole reads;
  EndpointRole writes;
  rmw_endpoint_type_t type;
};

constexpr Side client_side{EndpointRole::reply, EndpointRole::request, RMW_ENDPOINT_CLIENT};
constexpr Side server_side{EndpointRole::request, EndpointRole::reply, RMW_ENDPOINT_SERVER};

/// A node's readers belong to its writers in the order of both. One that is being created or
/// destroyed may lack its other half, and is left out.
std::vector<ServiceEndpoint> endpoints_of_side(
  const Node & node, const char * service, const Side & side) {
  std::vector<EndpointInfo> writers =
    endpoints_of(node, service, EndpointKind::publisher, side.writes);
  std::vector<ServiceEndpoint> found;
  for (EndpointInfo & reader :
       endpoints_of(node, service, EndpointKind::subscription, side.reads)) {
    const auto own = std::find_if(writers.begin(), writers.end(), [&](const EndpointInfo & writer) {
      return writer.node == reader.node && writer.process == reader.process;
    });
    if (own != writers.end()) {
      found.push_back({std::move(reader), std::move(*own)});
      writers.erase(own);
    }
  }
  return found;
}

void write_service(
  const ServiceEndpoint & endpoint, const manycore::NodeInfo & node, rmw_endpoint_type_t type,
  rcutils_allocator_t & allocator, rmw_service_endpoint_info_t & info) {
  check(rmw_service_endpoint_info_set_node_name(&info, node.name.c_str(), &allocator));
  check(rmw_service_endpoint_info_set_node_namespace(&info, node.ns.c_str(), &allocator));
  check(
    rmw_service_endpoint_info_set_service_type(&info, endpoint.reader.type.c_str(), &allocator));
  const rosidl_type_hash_t hash = to_rosidl(endpoint.reader.type_hash);
  check(rmw_service_endpoint_info_set_service_type_hash(&info, &hash));
  check(rmw_service_endpoint_info_set_endpoint_type(&info, type));
  const std::array<manycore::Gid, 2> gids{endpoint.reader.gid, endpoint.writer.gid};
  const std::array<rmw_qos_profile_t, 2> profiles{
    to_rmw(endpoint.reader.qos), to_rmw(endpoint.writer.qos)};
  check(rmw_service_endpoint_info_set_endpoint_count(&info, gids.size()));
  check(rmw_service_endpoint_info_set_gids(
    &info, gids[0].data(), gids.size(), gids[0].size(), &allocator));
  check(rmw_service_endpoint_info_set_qos_profiles(
    &info, profiles.data(), profiles.size(), &allocator));
}

rmw_ret_t write_side(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * service,
  rmw_service_endpoint_info_array_t * result, const Side & side) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ARGUMENT(service);
  if (rmw_service_endpoint_info_array_check_zero(result) != RMW_RET_OK) {
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  return guarded([&] {
    const Node & asking = Node::of(node);
    const std::vector<ServiceEndpoint> found = endpoints_of_side(asking, service, side);
    if (found.empty()) {
      return RMW_RET_OK;
    }
    const std::vector<manycore::NodeInfo> nodes = asking.process().graph().nodes();
    auto made = rmw_get_zero_initialized_service_endpoint_info_array();
    check(rmw_service_endpoint_info_array_init_with_size(&made, found.size(), allocator));
    auto free_made = rcpputils::make_scope_exit(
      [&] { ignore(rmw_service_endpoint_info_array_fini(&made, allocator)); });
    for (size_t i = 0; i < found.size(); ++i) {
      const manycore::NodeInfo owner = find_node(nodes, found[i].reader.node);
      write_service(found[i], owner, side.type, *allocator, made.info_array[i]);
    }
    free_made.cancel();
    *result = made;
    return RMW_RET_OK;
  });
}

}  // namespace
}  // namespace rmw_manycore

// Names are not mangled, so `no_mangle` has no effect.

rmw_ret_t rmw_get_clients_info_by_service(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * service_name,
  bool /*no_mangle*/, rmw_service_endpoint_info_array_t * clients_info) {
  return rmw_manycore::write_side(
    node, allocator, service_name, clients_info, rmw_manycore::client_side);
}

rmw_ret_t rmw_get_servers_info_by_service(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * service_name,
  bool /*no_mangle*/, rmw_service_endpoint_info_array_t * servers_info) {
  return rmw_manycore::write_side(
    node, allocator, service_name, servers_info, rmw_manycore::server_side);
}

#endif
