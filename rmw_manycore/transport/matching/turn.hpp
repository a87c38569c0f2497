// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace manycore {

/// How much of matching, closing and sweeping is done while the registry lock is held once. Counted
/// in steps of about 0.1 us (a look at an entry that is not in the cache), so that a turn takes
/// about 50 us.
class Turn {
public:
  static constexpr uint32_t steps = 512;
  static constexpr uint32_t records_in_a_step = 16;

  bool is_over() const noexcept { return left_ == 0; }
  void spend(uint64_t cost) noexcept {
    left_ -= static_cast<uint32_t>(std::min<uint64_t>(cost, left_));
  }

private:
  uint32_t left_ = steps;
};

}  // namespace manycore
