// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Wake-ups collected for one message, so that each thread is woken once, however many of its
/// subscriptions received the message.
class PendingWakes {
public:
  explicit PendingWakes(Registry & registry) noexcept : registry_(registry) {}

  /// Requires `process` < high_water().
  void add(uint32_t process, const WakeSet & words) noexcept {
    if (words_[process].empty() && !words.empty()) {
      processes_[count_++] = process;
    }
    words_[process] |= words;
  }
  /// In the order in which they were added.
  void flush() noexcept {
    for (uint32_t i = 0; i < count_; ++i) {
      const uint32_t process = processes_[i];
      registry_.tracer().note(TraceKind::wake, nothing, process, words_[process].count());
      registry_.processes()[process].wake.notify(words_[process]);
      words_[process] = {};
    }
    count_ = 0;
  }

private:
  Registry & registry_;
  std::array<WakeSet, process_capacity> words_{};  ///< by process slot
  /// Slots with a non-empty set; the first `count_` are valid.
  std::array<uint32_t, process_capacity> processes_;
  uint32_t count_ = 0;
};

}  // namespace manycore
