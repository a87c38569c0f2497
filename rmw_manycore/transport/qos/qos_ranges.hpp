// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/endpoint.hpp"

namespace manycore {

/// Throws Error{invalid_argument} naming the first invalid value: a history depth of 0 or more than
/// 2^20, or a duration of 0 ns or less.
void check_qos_ranges(const EndpointSpec & spec);

}  // namespace manycore
