// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/leaving.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "transport/matching/closing.hpp"
#include "transport/matching/sweeping.hpp"
#include "transport/registry/slots_of_process.hpp"

namespace manycore {
namespace {

/// Returns the slots of publishers that may be free of readers now.
std::vector<uint32_t> close(Registry & registry, uint32_t endpoint) {
  std::vector<uint32_t> unread;
  const Registry::Lock lock(registry, registry.parting_wait_ns());
  if (registry.endpoints().is_live(endpoint)) {
    try {
      closing::close(registry, endpoint, false, unread);
    } catch (const ClusterUnmappable &) {
      // It stays live until the process ends.
    }
  }
  return unread;
}

}  // namespace

void leave_graph(Registry & registry, uint32_t endpoint) noexcept {
  try {
    const Cluster & cluster = registry.clusters().at(registry.endpoints()[endpoint].cluster);
    std::vector<uint32_t> closed = close(registry, endpoint);
    if (std::find(closed.begin(), closed.end(), endpoint) == closed.end()) {
      closed.push_back(endpoint);
    }
    for (const uint32_t each : closed) {
      if (sweeping::sweep(registry, each, registry.parting_wait_ns()) == sweeping::Result::in_use) {
        cluster.wake_reaper();
      }
    }
  } catch (const std::exception &) {
    // The registry stayed locked: the endpoint is closed when its process leaves or ends.
  }
  registry.graph_changed();
}

bool close_endpoints_of(
  Registry & registry, uint32_t process, bool died, const std::function<bool()> & may_go_on) {
  std::optional<ClusterUnmappable> obstacle;
  std::vector<uint32_t> unread;  // the sweep that follows looks at all
  for (const uint32_t slot : slots_of_process(registry.endpoints(), process)) {
    const Registry::Lock lock(registry, registry.parting_wait_ns());
    if (!may_go_on()) {
      return false;
    }
    if (!is_of_process(registry.endpoints()[slot], process)) {
      continue;
    }
    try {
      closing::close(registry, slot, died, unread);
    } catch (const ClusterUnmappable & error) {
      obstacle.emplace(error);
    }
  }
  if (obstacle) {
    throw ClusterUnmappable(*obstacle);
  }
  return true;
}

}  // namespace manycore
