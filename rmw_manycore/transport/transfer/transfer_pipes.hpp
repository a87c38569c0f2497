// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore::transfer_pipes {

/// Priorities of the platform's messages, the highest first. The topic table does not change.
std::vector<uint32_t> priorities(const Registry & registry);
bool has_sessions(const Registry & registry) noexcept;

/// Creates those of a cluster that has just been made; the caller holds the join lock.
void create(const Registry & registry, const PlatformPaths & paths, uint32_t cluster);

}  // namespace manycore::transfer_pipes
