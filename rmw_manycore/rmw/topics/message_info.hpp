// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/types.h"
#include "transport/subscription/subscription.hpp"

namespace rmw_manycore {

rmw_gid_t to_rmw(const manycore::Gid & gid);
rmw_message_info_t to_rmw(const manycore::RecordInfo & info);
/// The request id of a service, carried by the request and its reply.
rmw_service_info_t to_service_info(const manycore::RecordInfo & info);
manycore::Correlation to_correlation(const rmw_request_id_t & id);

}  // namespace rmw_manycore
