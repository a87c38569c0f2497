// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"

namespace manycore {

/// What threads of a process sleep on.
struct WakeWord {
  FutexWord epoch;
  std::atomic<uint32_t> sleepers;

  /// Raises the epoch; one system call only if a thread sleeps.
  ///
  /// No wake-up is lost: the sleeper counts itself before the kernel compares the epoch, the waker
  /// raises the epoch before it looks at the count; both are seq_cst, so one of them sees the
  /// other.
  void notify() noexcept {
    epoch.fetch_add(1, std::memory_order_seq_cst);
    if (sleepers.load(std::memory_order_seq_cst) != 0) {
      futex_wake_all(epoch);
    }
  }
};

/// Bit i = wake word i of a process.
using WakeMask = uint64_t;

constexpr uint32_t wake_words_per_process = 64;
/// The word of those that wait for whatever their process gets; the others are threads' own.
constexpr WakeMask common_word = 1;

/// The wake words behind which something is waited for. A thread adds its own before it looks and
/// sleeps; it stays there until the thread was woken for nothing, so waiting again costs a load.
///
/// No wake-up is lost: the waiting thread adds its word before it looks for the cause, the waker
/// makes the cause before it reads the words; all seq_cst, so one of them sees the other. See
/// docs/model/waiting.pml.
struct Watchers {
  std::atomic<WakeMask> words;

  void add(WakeMask word) noexcept {
    if ((words.load(std::memory_order_seq_cst) & word) == 0) {
      words.fetch_or(word, std::memory_order_seq_cst);
    }
  }
  void remove(WakeMask word) noexcept {
    if ((words.load(std::memory_order_relaxed) & word) != 0) {
      words.fetch_and(~word, std::memory_order_seq_cst);
    }
  }
  WakeMask read() const noexcept { return words.load(std::memory_order_seq_cst); }
};

/// In the registry, one per process slot.
struct alignas(64) WakeWords {
  WakeWord words[wake_words_per_process];
  Watchers graph;            ///< of changes of the graph
  Watchers endpoint_events;  ///< of matches, incompatible QoS, losses, deadlines

  void notify(WakeMask mask) noexcept {
    for (; mask != 0; mask &= mask - 1) {
      words[__builtin_ctzll(mask)].notify();
    }
  }
  /// Those to be woken by an arrival at a subscription of the process.
  WakeMask mask_of(const Watchers & arrivals, bool changes_events) const noexcept {
    return arrivals.read() | (changes_events ? endpoint_events.read() : 0);
  }
  void notify_all() noexcept { notify(~WakeMask{0}); }
  void notify(const Watchers & watchers) noexcept { notify(watchers.read()); }

  /// Once, before the process that has taken the slot is known to anybody.
  void reset() noexcept {
    for (WakeWord & word : words) {
      word.sleepers.store(0);
    }
    graph.words.store(0);
    endpoint_events.words.store(0);
  }
};
static_assert(sizeof(WakeWords) == 576);

}  // namespace manycore
