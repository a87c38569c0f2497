// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/rmw.h"
#include "rmw/services/client.hpp"
#include "rmw/services/service.hpp"
#include "rmw/topics/message_info.hpp"
#include "virtual_time/door.hpp"

rmw_ret_t rmw_send_request(
  const rmw_client_t * client, const void * ros_request, int64_t * sequence_id) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);
  MANYCORE_CHECK_ARGUMENT(ros_request);
  MANYCORE_CHECK_ARGUMENT(sequence_id);

  // Implementation
  return rmw_manycore::guarded([&] {
    auto & asking = rmw_manycore::Client::of(client);
    const rmw_manycore::Cdr & cdr = asking.type().request;
    const int64_t now_ns = manycore::publish_now_ns(asking.requests().slot());
    manycore::Draft draft = asking.requests().draft(cdr.size_bound(ros_request));
    const size_t size = cdr.serialize(ros_request, draft.data(), draft.capacity());
    const manycore::Correlation correlation = asking.next_request();
    if (const auto send = rmw_manycore::tracepoints().send_request) {
      send(client, ros_request, correlation.number);
    }
    asking.requests().publish(std::move(draft), size, now_ns, correlation);
    *sequence_id = correlation.number;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_take_request(
  const rmw_service_t * service, rmw_service_info_t * request_header, void * ros_request,
  bool * taken) {
  // Invariants
  MANYCORE_CHECK_HANDLE(service);
  MANYCORE_CHECK_ARGUMENT(request_header);
  MANYCORE_CHECK_ARGUMENT(ros_request);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    auto & serving = rmw_manycore::Service::of(service);
    const auto info = serving.requests().take(serving.type().request, ros_request);
    if (info) {
      *request_header = rmw_manycore::to_service_info(*info);
      *taken = true;
    }
    if (const auto traced = rmw_manycore::tracepoints().take_request) {
      const manycore::Correlation from = info ? info->correlation : manycore::Correlation{};
      traced(service, ros_request, from.client.data(), from.number, *taken);
    }
    return RMW_RET_OK;
  });
}
