// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/leaving.hpp"

#include <vector>

#include "transport/matching/closing.hpp"
#include "transport/matching/sweeping.hpp"

namespace manycore {
namespace {

/// Returns the slots of publishers that are gone and that no subscription reads any more.
std::vector<uint32_t> close(Registry & registry, uint32_t endpoint) {
  std::vector<uint32_t> unread;
  const Slot & slot = registry.endpoints()[endpoint].slot;
  const uint32_t incarnation = slot.incarnation.load();
  for (bool closed = false; !closed;) {
    const Registry::Lock lock(registry, registry.parting_wait_ns());
    if (slot.state.load() == SlotState::free || slot.incarnation.load() != incarnation) {
      break;  // another process closed and freed it
    }
    try {
      Turn turn;
      closed = closing::close_some(registry, endpoint, false, turn, &unread);
    } catch (const ClusterUnmappable &) {
      break;  // a cluster cannot be mapped: the following sweep wakes the reaper
    }
  }
  return unread;
}

/// Sweeps one endpoint by itself, because a brief round need not come to it.
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
    const std::vector<uint32_t> unread = close(registry, endpoint);
    sweep(registry, endpoint);
    for (const uint32_t publisher : unread) {
      sweep(registry, publisher);
    }
    sweeping::sweep_a_little(registry, cluster, registry.parting_wait_ns());
  } catch (const std::exception &) {
    // The registry stayed locked: the endpoint is closed when its process leaves or ends.
  }
  registry.graph_changed();
}

}  // namespace manycore
