// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore {

template<typename Entry>
bool is_of_process(const Entry & entry, uint32_t process) noexcept {
  return entry.slot.state.load(std::memory_order_acquire) != SlotState::free &&
         entry.process.load(std::memory_order_relaxed) == process;
}

/// Returns the slots of a table that a dead or leaving process uses. Such a process takes no
/// further slots, so they are found without the registry lock. The caller checks each again under
/// the lock.
template<typename Entry>
std::vector<uint32_t> slots_of_process(const Table<Entry> & table, uint32_t process) {
  std::vector<uint32_t> slots;
  for (uint32_t slot = 0; slot < table.high_water(); ++slot) {
    if (is_of_process(table[slot], process)) {
      slots.push_back(slot);
    }
  }
  return slots;
}

}  // namespace manycore
