// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "platform/clock.hpp"
#include "platform/shared_memory.hpp"
#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {

/// Amount of matching, closing and sweeping done during one hold of the registry lock. Counted in
/// steps of about 0.1 us (an access to an entry outside the cache); a turn takes about 50 us. A
/// step takes longer in a process that touches memory for the first time, as a reaper does, so a
/// turn also reads the clock.
class Turn {
public:
  static constexpr uint32_t steps = 512;
  static constexpr uint32_t records_in_a_step = 16;

  bool is_over() const noexcept { return left_ == 0 || is_late_; }
  uint32_t spent() const noexcept { return steps - left_; }
  void end() noexcept { left_ = 0; }

  /// Charges what it takes to free a piece of a block. A hole may take as long as a turn whatever
  /// its size, because other CPUs are interrupted: there is at most one in a turn, and only in its
  /// first half. False, without a charge, if it has to wait for the next turn.
  [[nodiscard]] bool begin_freeing(uint64_t block_bytes) noexcept {
    constexpr uint64_t bytes_in_a_step = 128;
    if (is_over() || left_ < steps / 2) {
      return false;
    }
    const bool makes_hole = block_bytes + page_bytes > min_hole_bytes;  // it may end with a page
    const uint64_t bytes = std::min(block_bytes, freed_piece_bytes);
    spend((makes_hole ? steps / 2 : 0) + 1 + bytes / bytes_in_a_step);
    return true;
  }

  void spend(uint64_t cost) noexcept {
    left_ -= static_cast<uint32_t>(std::min<uint64_t>(cost, left_));
    if (left_ <= look_at_) {
      look_at_ = left_ - std::min(left_, steps_between_looks);
      is_late_ = monotonic_ns() - began_ns_ >= max_ns;
    }
  }

private:
  static constexpr uint32_t steps_between_looks = 32;  ///< of the clock; minimum per turn
  static constexpr int64_t max_ns = 50'000;

  const int64_t began_ns_ = monotonic_ns();
  uint32_t left_ = steps;
  uint32_t look_at_ = steps - steps_between_looks;  ///< reads the clock at this `left_`
  bool is_late_ = false;
};

}  // namespace manycore
