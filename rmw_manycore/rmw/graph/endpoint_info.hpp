// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "rosidl_runtime_c/type_hash.h"
#include "transport/registry/graph.hpp"

namespace rmw_manycore {

rosidl_type_hash_t to_rosidl(const manycore::TypeHash & hash);

/// The node with this handle. It may have been removed between two reads of the graph; its name is
/// then unknown.
manycore::NodeInfo find_node(const std::vector<manycore::NodeInfo> & nodes, uint32_t handle);

}  // namespace rmw_manycore
