// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/qos.hpp"

namespace manycore {

/// DDS request-offer rule: `none` if `offered` satisfies `requested`, else the last failing policy,
/// which is the one that Fast DDS reports.
QosPolicy last_incompatible_policy(const Qos & offered, const Qos & requested);

}  // namespace manycore
