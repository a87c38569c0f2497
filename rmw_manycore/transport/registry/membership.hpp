// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/fork_side.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Says whether a slot of the registry is still what its holder took: not when the holder was taken
/// for dead, nor when the platform's files were removed, nor in a child that inherited it.
class Membership {
public:
  Membership(const Registry & registry, const Slot & slot) noexcept
  : removed_(registry.header().removed),
    slot_(slot),
    incarnation_(slot.incarnation.load(std::memory_order_relaxed)) {}

  bool is_inherited() const noexcept { return side_.is_inherited(); }
  bool holds() const noexcept {
    return !is_inherited() && slot_.state.load(std::memory_order_relaxed) == SlotState::live &&
           slot_.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }
  /// True once the platform's files were removed. The memory is there until the last one leaves.
  bool is_cut_off() const noexcept { return removed_.load(std::memory_order_relaxed) != 0; }
  /// Throws Error{system} that says what to do unless it holds.
  void require() const {
    if (!holds() || is_cut_off()) {
      refuse();
    }
  }

private:
  [[noreturn]] void refuse() const;

  const std::atomic<uint32_t> & removed_;
  const Slot & slot_;
  const uint32_t incarnation_;
  const ForkSide side_;
};

}  // namespace manycore
