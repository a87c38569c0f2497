// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace manycore {

/// What the thread that calls the callbacks of a process has to look at once it is woken, so that
/// it looks at a few of hundreds of subscriptions. Part of the process's registry entry.
///
/// No arrival is missed: a notifier marks after the arrival and before it raises the word that the
/// thread sleeps on; the thread takes the marks after it has read that word and before it looks. So
/// what it does not look at was marked later, and the word raised after that ends its sleep at
/// once. All accesses are seq_cst. Model: docs/model/callbacks.pml.
class CallbackMarks {
public:
  static constexpr uint32_t words = 4;
  static constexpr uint32_t count = words * 64;

  /// Mark of a subscription, which a few others share: a hash of its endpoint slot, as the nodes of
  /// one process have slots at equal distances.
  static constexpr uint32_t of(uint32_t endpoint) noexcept { return endpoint * 0x9e3779b1u >> 24; }

  struct Taken {
    std::array<uint64_t, words> subscriptions{};
    bool events = false;

    /// Calls `visit(mark)` for each marked group of subscriptions.
    template<typename Visit>
    void for_each_mark(Visit visit) const {
      for (uint32_t i = 0; i < words; ++i) {
        for (uint64_t left = subscriptions[i]; left != 0; left &= left - 1) {
          visit(i * 64 + static_cast<uint32_t>(__builtin_ctzll(left)));
        }
      }
    }
  };
  static constexpr Taken everything() noexcept {
    Taken all;
    for (uint64_t & word : all.subscriptions) {
      word = ~uint64_t{0};
    }
    all.events = true;
    return all;
  }

  void mark(uint32_t endpoint) noexcept {
    subscriptions_[of(endpoint) / 64].fetch_or(uint64_t{1} << of(endpoint) % 64);
  }
  /// An exchange, as a store would keep the thread from seeing what came before an earlier mark.
  void mark_events() noexcept { events_.exchange(1); }
  void mark_everything() noexcept {
    for (std::atomic<uint64_t> & word : subscriptions_) {
      word.fetch_or(~uint64_t{0});
    }
    mark_events();
  }
  Taken take() noexcept {
    Taken taken;
    for (uint32_t i = 0; i < words; ++i) {
      taken.subscriptions[i] = subscriptions_[i].load() == 0 ? 0 : subscriptions_[i].exchange(0);
    }
    taken.events = events_.load() != 0 && events_.exchange(0) != 0;
    return taken;
  }

private:
  std::atomic<uint64_t> subscriptions_[words];  ///< by of()
  std::atomic<uint32_t> events_;
};
static_assert(sizeof(CallbackMarks) == 40 && CallbackMarks::of(~0u) < CallbackMarks::count);

}  // namespace manycore
