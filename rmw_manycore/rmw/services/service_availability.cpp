// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/services/client.hpp"

rmw_ret_t rmw_service_server_is_available(
  const rmw_node_t * node, const rmw_client_t * client, bool * is_available) {
  // Invariants: rmw requires RMW_RET_ERROR for null here
  RMW_CHECK_ARGUMENT_FOR_NULL(node, RMW_RET_ERROR);
  RMW_CHECK_ARGUMENT_FOR_NULL(client, RMW_RET_ERROR);
  RMW_CHECK_ARGUMENT_FOR_NULL(is_available, RMW_RET_ERROR);
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_HANDLE(client);

  // Implementation
  return rmw_manycore::guarded([&] {
    auto & asking = rmw_manycore::Client::of(client);
    *is_available = asking.requests().transport().matched().current != 0 &&
                    asking.replies().transport().matched().current != 0;
    return RMW_RET_OK;
  });
}
