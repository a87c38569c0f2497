// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "platform/lifeline.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// A slot of the process table, not filled in yet, and the line of the same number.
struct SlotAndLine {
  uint32_t slot;
  HeldLifeline line;
};

/// Takes a free slot and its line for a process that joins. Passes over lines that are still held
/// by processes that have just given back their slots, or that are damaged. The caller holds the
/// join lock and the registry lock. Throws Error{no_space|corrupt|system}.
SlotAndLine take_slot_and_line(Registry & registry, std::unique_ptr<LifeThread> & life);

}  // namespace manycore
