// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "transport/matching/turn.hpp"
#include "transport/matching/undelivered.hpp"

namespace manycore::sweeping {

/// What the newest hints in a subscription's queue tell about a reader.
struct HintedSources {
  static constexpr size_t most = 64;  ///< hints that are looked at

  bool is_own = false;                  ///< a hint is of a record that the reader has not taken
  std::array<uint32_t, most> others{};  ///< indices of the other sources, each once
  size_t other_count = 0;

  void add_other(uint32_t source) noexcept {
    const auto end = others.begin() + other_count;
    if (std::find(others.begin(), end, source) == end) {
      others[other_count++] = source;
    }
  }
};

/// Without any if the queue is damaged. The caller holds the registry lock.
HintedSources hinted_sources(
  Registry & registry, const closing::OrphanReader & reader, Turn & turn);

}  // namespace manycore::sweeping
