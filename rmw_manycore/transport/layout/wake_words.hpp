// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "platform/futex.hpp"
#include "transport/layout/callback_marks.hpp"

namespace manycore {

/// Word that threads of a process sleep on.
struct WakeWord {
  FutexWord epoch;
  std::atomic<uint32_t> sleepers;

  /// Increments the epoch; makes a system call only if a thread sleeps.
  ///
  /// No wake-up is lost: the sleeper increments `sleepers` before the kernel compares the epoch,
  /// the waker increments the epoch before it loads `sleepers`. All accesses are seq_cst, so at
  /// least one of them sees the other.
  void notify() noexcept {
    epoch.fetch_add(1, std::memory_order_seq_cst);
    if (sleepers.load(std::memory_order_seq_cst) != 0) {
      futex_wake_all(epoch);
    }
  }
};

/// Enough for a hundred threads to have one each, and for further ones to share the rest.
constexpr uint32_t wake_words_per_process = 128;
/// Word of the threads that wait for any notification of their process.
constexpr uint32_t common_word = 0;
/// Word of the thread that calls callbacks for arrivals. No other thread sleeps on it, so a
/// publisher that makes the calls for its message need not wake it.
constexpr uint32_t callback_word = 1;
constexpr uint32_t first_thread_word = 2;

/// Set of wake words of one process.
struct WakeSet {
  static constexpr uint32_t words_per_part = 64;
  static constexpr uint32_t part_count = wake_words_per_process / words_per_part;

  std::array<uint64_t, part_count> parts{};

  static constexpr uint64_t bit(uint32_t word) noexcept {
    return uint64_t{1} << word % words_per_part;
  }
  static constexpr WakeSet of(uint32_t word) noexcept {
    WakeSet set;
    set.parts[word / words_per_part] = bit(word);
    return set;
  }
  bool contains(uint32_t word) const noexcept {
    return (parts[word / words_per_part] & bit(word)) != 0;
  }
  bool empty() const noexcept {
    uint64_t any = 0;
    for (const uint64_t part : parts) {
      any |= part;
    }
    return any == 0;
  }
  uint32_t count() const noexcept {
    uint32_t words = 0;
    for (const uint64_t part : parts) {
      words += static_cast<uint32_t>(__builtin_popcountll(part));
    }
    return words;
  }
  WakeSet without(const WakeSet & other) const noexcept {
    WakeSet rest = *this;
    for (uint32_t i = 0; i < part_count; ++i) {
      rest.parts[i] &= ~other.parts[i];
    }
    return rest;
  }
  WakeSet & operator|=(const WakeSet & other) noexcept {
    for (uint32_t i = 0; i < part_count; ++i) {
      parts[i] |= other.parts[i];
    }
    return *this;
  }
  template<typename Visit>
  void for_each(Visit visit) const {
    for (uint32_t i = 0; i < part_count; ++i) {
      for (uint64_t left = parts[i]; left != 0; left &= left - 1) {
        visit(i * words_per_part + static_cast<uint32_t>(__builtin_ctzll(left)));
      }
    }
  }
};

/// Wake words of the threads that wait for one cause. A thread adds its word before it checks the
/// cause and sleeps. The word stays until the thread is woken for nothing, so waiting again costs
/// one load.
///
/// No wake-up is lost: the waiting thread adds its word before it checks the cause, the waker
/// makes the cause true before it reads the words. All accesses are seq_cst, so at least one of
/// them sees the other. A thread has one word, so the parts need not be read atomically together.
/// Model: docs/model/waiting.pml.
struct Watchers {
  std::atomic<uint64_t> parts[WakeSet::part_count];

  void add(uint32_t word) noexcept {
    std::atomic<uint64_t> & part = parts[word / WakeSet::words_per_part];
    if ((part.load(std::memory_order_seq_cst) & WakeSet::bit(word)) == 0) {
      part.fetch_or(WakeSet::bit(word), std::memory_order_seq_cst);
    }
  }
  void remove(uint32_t word) noexcept {
    std::atomic<uint64_t> & part = parts[word / WakeSet::words_per_part];
    if ((part.load(std::memory_order_relaxed) & WakeSet::bit(word)) != 0) {
      part.fetch_and(~WakeSet::bit(word), std::memory_order_seq_cst);
    }
  }
  WakeSet read() const noexcept {
    WakeSet set;
    for (uint32_t i = 0; i < WakeSet::part_count; ++i) {
      set.parts[i] = parts[i].load(std::memory_order_seq_cst);
    }
    return set;
  }
  /// Call before any thread waits.
  void reset() noexcept {
    for (std::atomic<uint64_t> & part : parts) {
      part.store(0);
    }
  }
};

/// Wake words and process-wide watchers of one process slot; part of its registry entry.
struct alignas(64) WakeWords {
  WakeWord words[wake_words_per_process];
  Watchers graph;            ///< of graph changes
  Watchers endpoint_events;  ///< of matches, incompatible QoS, losses and deadlines
  /// For the thread on `callback_word`. Not in the line that each notifier reads.
  alignas(64) CallbackMarks marks;

  /// Raises words. For what callbacks are about, mark_arrival() and mark_events() return them.
  void notify(const WakeSet & set) noexcept {
    set.for_each([this](uint32_t word) { words[word].notify(); });
  }
  /// After an arrival at a subscription of the process: marks it, and returns the words to wake.
  /// `spared` are woken for events only.
  WakeSet mark_arrival(
    const Watchers & arrivals, uint32_t endpoint, bool changes_events,
    const WakeSet & spared = {}) noexcept {
    WakeSet set = arrivals.read().without(spared);
    if (set.contains(callback_word)) {
      marks.mark(endpoint);
    }
    if (changes_events) {
      set |= mark_events();
    }
    return set;
  }
  WakeSet mark_events() noexcept {
    const WakeSet set = endpoint_events.read();
    if (set.contains(callback_word)) {
      marks.mark_events();
    }
    return set;
  }
  void notify_arrival(const Watchers & arrivals, uint32_t endpoint) noexcept {
    notify(mark_arrival(arrivals, endpoint, false));
  }
  void notify_events() noexcept { notify(mark_events()); }
  /// No callback is about the graph.
  void notify_graph() noexcept { notify(graph.read()); }
  void notify_all() noexcept {
    marks.mark_everything();
    for (WakeWord & word : words) {
      word.notify();
    }
  }

  /// Call once after taking the slot, before the process is visible to others.
  void reset() noexcept {
    for (WakeWord & word : words) {
      word.sleepers.store(0);
    }
    graph.reset();
    endpoint_events.reset();
    marks.mark_everything();
  }
};
static_assert(sizeof(WakeWords) == 1152);

}  // namespace manycore
