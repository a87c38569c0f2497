// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/types.h"

namespace rmw_manycore {

/// Throw manycore::Error{invalid_argument} with the reason if the name is invalid.
void check_node_name(const char * name);
void check_namespace(const char * ns);
/// Checks the fully qualified name of a topic or service.
void check_full_name(const char * name);
/// As check_full_name(), unless the profile avoids ROS name conventions; rejects empty names
/// always.
void check_endpoint_name(const char * name, const rmw_qos_profile_t & profile);

}  // namespace rmw_manycore
