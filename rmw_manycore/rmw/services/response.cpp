// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/rmw.h"
#include "rmw/services/client.hpp"
#include "rmw/services/service.hpp"
#include "rmw/topics/message_info.hpp"
#include "virtual_time/door.hpp"

rmw_ret_t rmw_send_response(
  const rmw_service_t * service, rmw_request_id_t * request_header, void * ros_response) {
  // Invariants
  MANYCORE_CHECK_HANDLE(service);
  MANYCORE_CHECK_ARGUMENT(request_header);
  MANYCORE_CHECK_ARGUMENT(ros_response);

  // Implementation: a reply to a client that has left is dropped without an error
  return rmw_manycore::guarded([&] {
    auto & serving = rmw_manycore::Service::of(service);
    const rmw_manycore::Cdr & cdr = serving.type().response;
    const int64_t now_ns = manycore::publish_now_ns(serving.replies().slot());
    manycore::Draft draft = serving.replies().draft(cdr.size_bound(ros_response));
    const size_t size = cdr.serialize(ros_response, draft.data(), draft.capacity());
    const manycore::Correlation correlation = rmw_manycore::to_correlation(*request_header);
    if (const auto send = rmw_manycore::tracepoints().send_response) {
      send(service, ros_response, correlation.client.data(), correlation.number, now_ns);
    }
    serving.replies().publish(std::move(draft), size, now_ns, correlation);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_take_response(
  const rmw_client_t * client, rmw_service_info_t * request_header, void * ros_response,
  bool * taken) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);
  MANYCORE_CHECK_ARGUMENT(request_header);
  MANYCORE_CHECK_ARGUMENT(ros_response);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    auto & asking = rmw_manycore::Client::of(client);
    const auto info = asking.replies().take(asking.type().response, ros_response);
    if (info) {
      *request_header = rmw_manycore::to_service_info(*info);
      *taken = true;
    }
    if (const auto traced = rmw_manycore::tracepoints().take_response) {
      traced(
        client, ros_response, info ? info->correlation.number : 0,
        info ? info->source_timestamp_ns : 0, *taken);
    }
    return RMW_RET_OK;
  });
}
