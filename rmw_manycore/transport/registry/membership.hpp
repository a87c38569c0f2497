// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/fork_side.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Checks that a registry slot still belongs to its holder. It does not after the holder was reaped
/// as dead, after the platform's files were removed, or in a child of fork().
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
  /// True once the platform's files are removed. The memory exists until the last process leaves.
  bool is_cut_off() const noexcept { return removed_.load(std::memory_order_relaxed) != 0; }
  /// Throws Error{system}, saying what to do, unless the slot is held and the platform exists.
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
