// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Wake-ups that one message asks for, so that each thread is woken once, however many of its
/// subscriptions the message reached.
class PendingWakes {
public:
  explicit PendingWakes(Registry & registry) noexcept : registry_(registry) {}

  /// `process`: a slot below the high water mark.
  void add(uint32_t process, const WakeSet & words) noexcept {
    if (words_[process].empty() && !words.empty()) {
      processes_[count_++] = process;
    }
    words_[process] |= words;
  }
  void flush() noexcept {
    while (count_ != 0) {
      const uint32_t process = processes_[--count_];
      registry_.tracer().note(TraceKind::wake, nothing, process, words_[process].count());
      registry_.processes()[process].wake.notify(words_[process]);
      words_[process] = {};
    }
  }

private:
  Registry & registry_;
  std::array<WakeSet, process_capacity> words_{};     ///< by process slot
  std::array<uint32_t, process_capacity> processes_;  ///< those with words, `count_` of them
  uint32_t count_ = 0;
};

}  // namespace manycore
