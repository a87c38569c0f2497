// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <vector>

#include "platform/cpu.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Reads of the registry without its lock: a stopped reader delays no change. See
/// docs/design/rows_seats_hands.md.

/// A copy of one table entry. It is consistent if the slot was live, with the same incarnation,
/// before and after the copy. The first loads are seq_cst: a caller may have made its phase odd
/// before them (Dekker with the process that frees).
template<typename Entry>
class EntryCopy {
public:
  EntryCopy(const Table<Entry> & table, uint32_t slot) noexcept
  : slot_(table[slot].slot),
    incarnation_(slot_.incarnation.load(std::memory_order_seq_cst)),
    state_(slot_.state.load(std::memory_order_seq_cst)) {
    copy_words(&table[slot]);
  }

  const Entry & operator*() const noexcept { return *reinterpret_cast<const Entry *>(bytes_); }
  /// True if the copy is consistent and the entry still exists.
  bool holds() const noexcept {
    std::atomic_thread_fence(std::memory_order_acquire);
    return state_ == SlotState::live &&
           slot_.state.load(std::memory_order_relaxed) == SlotState::live &&
           slot_.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }

  /// State before the copy.
  SlotState state() const noexcept { return state_; }
  uint32_t incarnation() const noexcept { return incarnation_; }
  /// True if the copy is consistent: the slot was in one use, of whatever state, before and after.
  bool is_whole() const noexcept {
    std::atomic_thread_fence(std::memory_order_acquire);
    return state_ != SlotState::free &&
           slot_.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }

private:
  using Word __attribute__((may_alias)) = uint64_t;
  static_assert(sizeof(Entry) % sizeof(Word) == 0);

  /// Runs concurrently with the writer, whose stores are not atomic: each word is loaded once, and
  /// holds() checks that the words belong together. Volatile because sanitizers instrument
  /// atomics even here.
  __attribute__((no_sanitize("thread"))) void copy_words(const Entry * entry) noexcept {
    const auto * const from = reinterpret_cast<const volatile Word *>(entry);
    for (size_t i = 0; i < sizeof(Entry) / sizeof(Word); ++i) {
      const uint64_t word = from[i];
      std::memcpy(bytes_ + i * sizeof word, &word, sizeof word);
    }
  }

  const Slot & slot_;
  /// Loaded before the state, so a use of the slot that begins in between is detected.
  uint32_t incarnation_;
  SlotState state_;
  alignas(Entry) std::byte bytes_[sizeof(Entry)];
};

/// Appends `describe(slot, entry)` of a live entry, unless the entry was removed meanwhile.
template<typename Entry, typename Info, typename Describe>
void append_live(
  const Table<Entry> & table, uint32_t slot, std::vector<Info> & all, Describe describe) {
  if (!table.is_live(slot)) {
    return;
  }
  const EntryCopy<Entry> copy(table, slot);
  if (copy.holds()) {
    all.push_back(describe(slot, *copy));
    if (!copy.holds()) {
      all.pop_back();
    }
  }
}

/// The same for all entries of a table.
template<typename Info, typename Entry, typename Describe>
std::vector<Info> list_live(const Table<Entry> & table, Describe describe) {
  std::vector<Info> all;
  for (uint32_t slot = 0; slot < table.high_water(); ++slot) {
    append_live(table, slot, all, describe);
  }
  return all;
}

/// Result of a `read()` during which nothing changed. If changes do not cease, or the lock's owner
/// is stopped, the result of the last attempt: each entry is consistent, but entries may be of
/// different moments.
template<typename Read>
auto read_between_changes(const Registry & registry, Read read) {
  constexpr int attempts = 16;
  const std::atomic<uint64_t> & changes = registry.header().changes;
  for (int i = 1;; ++i) {
    const uint64_t before = changes.load(std::memory_order_acquire);
    const bool is_changing = before % 2 != 0;
    if (is_changing && i < attempts) {
      yield_cpu();
      continue;
    }
    auto result = read(is_changing);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (i >= attempts || changes.load(std::memory_order_relaxed) == before) {
      return result;
    }
  }
}

}  // namespace manycore
