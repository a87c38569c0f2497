// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Removes the reader of a source from its topic DSM's reader table. The caller holds the registry
/// lock. Throws ClusterUnmappable before anything is changed.
void detach_reader(Registry & registry, SourceEntry & source);

}  // namespace manycore
