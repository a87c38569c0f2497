// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/fork_side.hpp"
#include "transport/layout/registry_layout.hpp"

namespace manycore {

/// Says whether a slot of the registry is still what its holder took: not when the holder was taken
/// for dead, nor in a child that inherited it.
class Membership {
public:
  explicit Membership(const Slot & slot) noexcept
  : slot_(slot), incarnation_(slot.incarnation.load(std::memory_order_relaxed)) {}

  bool is_inherited() const noexcept { return side_.is_inherited(); }
  bool holds() const noexcept {
    return !is_inherited() && slot_.state.load(std::memory_order_relaxed) == SlotState::live &&
           slot_.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }
  /// Throws Error{system} that says what to do unless it holds.
  void require() const {
    if (!holds()) {
      refuse();
    }
  }

private:
  [[noreturn]] void refuse() const;

  const Slot & slot_;
  const uint32_t incarnation_;
  const ForkSide side_;
};

}  // namespace manycore
