// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Removes the reader of a source in cluster `receiver` from its topic DSM's reader table. If it
/// was the last one there, no more records are transferred to that cluster. The caller holds the
/// registry lock. Throws ClusterUnmappable before anything is changed.
void detach_reader(Registry & registry, SourceEntry & source, uint32_t receiver);

}  // namespace manycore
