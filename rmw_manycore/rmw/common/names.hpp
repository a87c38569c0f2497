// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/types.h"

namespace rmw_manycore {

/// Throw manycore::Error{invalid_argument} that says what is wrong with the name.
void check_node_name(const char * name);
void check_namespace(const char * ns);
/// Fully qualified name of a topic or service.
void check_full_name(const char * name);
/// The same unless the profile asks for names outside ROS; never empty.
void check_endpoint_name(const char * name, const rmw_qos_profile_t & profile);

}  // namespace rmw_manycore
