// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/slot_and_line.hpp"

#include <vector>

namespace manycore {
namespace {

/// Slots that are given back at its end, in the reverse order.
struct PassedOver {
  ~PassedOver() {
    for (; !slots.empty(); slots.pop_back()) {
      processes.give_back(slots.back());
    }
  }
  Table<ProcessEntry> & processes;
  std::vector<uint32_t> slots{};
};

}  // namespace

SlotAndLine take_slot_and_line(Registry & registry, std::unique_ptr<LifeThread> & life) {
  PassedOver passed_over{registry.processes()};
  while (true) {
    passed_over.slots.push_back(registry.processes().take("processes"));
    const uint32_t slot = passed_over.slots.back();
    if (std::optional<HeldLifeline> line = registry.lifelines().try_hold(slot, life)) {
      passed_over.slots.pop_back();
      return {slot, std::move(*line)};
    }
  }
}

}  // namespace manycore
