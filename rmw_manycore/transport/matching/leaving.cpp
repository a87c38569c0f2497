// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/leaving.hpp"

#include "transport/matching/closing.hpp"
#include "transport/matching/sweeping.hpp"

namespace manycore {
namespace {

void close(Registry & registry, uint32_t endpoint) {
  const Slot & slot = registry.endpoints()[endpoint].slot;
  const uint32_t incarnation = slot.incarnation.load();
  for (bool closed = false; !closed;) {
    const Registry::Lock lock(registry, registry.parting_wait_ns());
    if (slot.state.load() == SlotState::free || slot.incarnation.load() != incarnation) {
      return;  // another process closed and freed it
    }
    try {
      Turn turn;
      closed = closing::close_some(registry, endpoint, false, turn);
    } catch (const ClusterUnmappable &) {
      return;  // a cluster cannot be mapped: the following sweep wakes the reaper
    }
  }
}

/// Sweeps this endpoint first, because the sweep of all endpoints may end early.
void sweep(Registry & registry, uint32_t endpoint) {
  sweeping::Round round(registry);
  for (bool swept = false; !swept;) {
    const Registry::Lock lock(registry, registry.parting_wait_ns());
    swept = round.sweep_some_of(endpoint);
  }
}

}  // namespace

void leave_graph(Registry & registry, uint32_t endpoint) noexcept {
  try {
    const uint32_t cluster = registry.endpoints()[endpoint].cluster;
    close(registry, endpoint);
    sweep(registry, endpoint);
    sweeping::sweep_a_little(registry, cluster, registry.parting_wait_ns());
  } catch (const std::exception &) {
    // The registry stayed locked: the endpoint is closed when its process leaves or ends.
  }
  registry.graph_changed();
}

}  // namespace manycore
