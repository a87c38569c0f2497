// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore {

/// Remembers in which process it was made. What a child of fork() inherits looks like its parent's,
/// but threads, locks and memberships stay with the parent.
class ForkSide {
public:
  ForkSide() noexcept : made_in_(forks_before()) {}

  /// True in a child of the process that made this.
  bool is_inherited() const noexcept { return made_in_ != forks_before(); }

private:
  /// Forks between the first process and this one.
  static uint32_t forks_before() noexcept;

  uint32_t made_in_;
};

}  // namespace manycore
