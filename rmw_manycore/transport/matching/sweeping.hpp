// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

/// Frees what closed endpoints hold, as soon as no process can be using it (see
/// docs/design/rows_seats_hands.md). What is left to free stands in shared memory, so any process
/// goes on where another one died.
namespace manycore::sweeping {

/// `freed`: nothing is left of the endpoint. `kept`: a reader wants the content and sweeps after
/// its last take, or the endpoint is not closed yet. `in_use`: another process is accessing the
/// memory at the moment and need not sweep afterwards, or this one cannot map a cluster: the reaper
/// has to look again.
enum class Result { freed, kept, in_use };

/// Sweeps one endpoint. Takes the registry lock for each large block. Throws Error{timeout}.
Result sweep(Registry & registry, uint32_t endpoint, long wait_ns = Registry::Lock::usual_wait_ns);

/// Sweeps all closed endpoints. True if one is `in_use`.
bool sweep_all(Registry & registry);

/// Sweeps one endpoint for a process of `cluster`, without waiting for the registry lock. Leaves
/// what it cannot free to the reaper.
void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept;

}  // namespace manycore::sweeping
