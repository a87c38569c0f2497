// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "rmw/common/checks.hpp"
#include "rmw/rmw.h"
#include "rmw/services/client.hpp"
#include "rmw/topics/message_info.hpp"
#include "rmw/topics/publisher.hpp"

rmw_ret_t rmw_get_gid_for_publisher(const rmw_publisher_t * publisher, rmw_gid_t * gid) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);
  MANYCORE_CHECK_ARGUMENT(gid);

  // Implementation
  *gid = rmw_manycore::to_rmw(rmw_manycore::Publisher::of(publisher).transport().gid());
  return RMW_RET_OK;
}

rmw_ret_t rmw_get_gid_for_client(const rmw_client_t * client, rmw_gid_t * gid) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);
  MANYCORE_CHECK_ARGUMENT(gid);

  // Implementation
  *gid = rmw_manycore::to_rmw(rmw_manycore::Client::of(client).gid());
  return RMW_RET_OK;
}

rmw_ret_t rmw_compare_gids_equal(const rmw_gid_t * gid1, const rmw_gid_t * gid2, bool * result) {
  // Invariants
  MANYCORE_CHECK_HANDLE(gid1);
  MANYCORE_CHECK_HANDLE(gid2);
  MANYCORE_CHECK_ARGUMENT(result);

  // Implementation
  *result = std::memcmp(gid1->data, gid2->data, sizeof gid1->data) == 0;
  return RMW_RET_OK;
}
