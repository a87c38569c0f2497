// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Takes the reader of a source off its topic DSM's reader table; the caller holds the registry
/// lock. Throws OutOfReach, and then has changed nothing.
void detach_reader(Registry & registry, SourceEntry & source);

}  // namespace manycore
