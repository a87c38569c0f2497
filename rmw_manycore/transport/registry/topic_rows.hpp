// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Calls `visit(EndpointEntry &, slot)` for each endpoint of a kind in the chain of a topic, live
/// or closed, until its memory is unreachable. The caller holds the registry lock.
template<typename Visit>
void for_each_row(Registry & registry, const char * topic, EndpointKind kind, Visit visit) {
  registry.for_each_of_bucket(topic, [&](uint32_t slot) {
    EndpointEntry & entry = registry.endpoints()[slot];
    if (entry.kind == kind && std::strncmp(entry.topic, topic, name_bytes) == 0) {
      visit(entry, slot);
    }
  });
}

inline bool is_live(const EndpointEntry & entry) noexcept {
  return entry.slot.state.load(std::memory_order_acquire) == SlotState::live;
}

}  // namespace manycore
