// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/smem_charge.hpp"

#include <utility>

#include "platform/error.hpp"

namespace manycore {

uint32_t process_of(Registry & registry, const ProcessIdentity & identity) {
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (registry.processes().is_live(slot) && registry.lifelines().holder(slot) == identity) {
      return slot;
    }
  }
  throw Error(
    ErrorCode::invalid_argument,
    "process " + std::to_string(identity.pid) + " is not on the platform");
}

// If this process dies between the two updates, the next owner of the lock sums up the entries
// anew.
void charge_smem(Registry & registry, const ProcessIdentity & identity, uint64_t size_bytes) {
  process_of(registry, identity);  // before the lock: a guest can lock only a platform that exists
  const Registry::Lock lock(registry);
  ProcessEntry & entry = registry.processes()[process_of(registry, identity)];
  registry.clusters().at(entry.cluster).charge(entry.charged_bytes, size_bytes);
  entry.charged_bytes = size_bytes;
}

void discharge(Registry & registry, uint32_t process) noexcept {
  ProcessEntry & entry = registry.processes()[process];
  Cluster * const cluster =
    entry.charged_bytes == 0 ? nullptr : registry.clusters().find(entry.cluster);
  if (cluster != nullptr) {
    cluster->charge(std::exchange(entry.charged_bytes, 0), 0);
  }
}

}  // namespace manycore
