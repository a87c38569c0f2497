// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

/// Remembers the process that created it. A child of fork() inherits copies of its parent's
/// objects, but threads, locks and memberships belong to the parent.
class ForkSide {
public:
  ForkSide() noexcept : made_in_(forks.load(std::memory_order_relaxed)) {}

  /// True in a child of the process that created this object.
  bool is_inherited() const noexcept { return made_in_ != forks.load(std::memory_order_relaxed); }

private:
  static void count_fork() noexcept { forks.fetch_add(1, std::memory_order_relaxed); }
  static const int registered;

  /// Number of forks between the first process and this one.
  static std::atomic<uint32_t> forks;

  uint32_t made_in_;
};

}  // namespace manycore
