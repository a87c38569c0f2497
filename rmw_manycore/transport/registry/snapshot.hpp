// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <vector>

#include "platform/cpu.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Looking at the registry without its lock: a reader that stands still holds up no change. See
/// docs/design/platform.md, Registry.

/// A copy of one table entry. It is whole if the slot was live, and the same use of it, before and
/// after the copy.
template<typename Entry>
class EntryCopy {
public:
  EntryCopy(const Table<Entry> & table, uint32_t slot) noexcept
  : slot_(table[slot].slot),
    incarnation_(slot_.incarnation.load(std::memory_order_acquire)),
    was_live_(slot_.state.load(std::memory_order_acquire) == SlotState::live) {
    copy_words(&table[slot]);
  }

  const Entry & operator*() const noexcept { return *reinterpret_cast<const Entry *>(bytes_); }
  /// True when what was copied is one entry, and was there all the time until now.
  bool holds() const noexcept {
    std::atomic_thread_fence(std::memory_order_acquire);
    return was_live_ && slot_.state.load(std::memory_order_relaxed) == SlotState::live &&
           slot_.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }

private:
  using Word __attribute__((may_alias)) = uint64_t;
  static_assert(sizeof(Entry) % sizeof(Word) == 0);

  /// Beside its writer, whose stores are no atomics: each word is loaded once, and holds() tells
  /// whether they belong together. Volatile, because sanitizers watch atomics even here.
  __attribute__((no_sanitize("thread"))) void copy_words(const Entry * entry) noexcept {
    const auto * const from = reinterpret_cast<const volatile Word *>(entry);
    for (size_t i = 0; i < sizeof(Entry) / sizeof(Word); ++i) {
      const uint64_t word = from[i];
      std::memcpy(bytes_ + i * sizeof word, &word, sizeof word);
    }
  }

  const Slot & slot_;
  uint32_t incarnation_;  ///< before the state: a use that began in between is not this one
  bool was_live_;
  alignas(Entry) std::byte bytes_[sizeof(Entry)];
};

/// Appends `describe(slot, entry)` of a live entry, unless it was gone before that was done.
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

/// The same of each entry of a table.
template<typename Info, typename Entry, typename Describe>
std::vector<Info> list_live(const Table<Entry> & table, Describe describe) {
  std::vector<Info> all;
  for (uint32_t slot = 0; slot < table.high_water(); ++slot) {
    append_live(table, slot, all, describe);
  }
  return all;
}

/// What `read()` returns while nothing changes. Where changes do not cease, or their author stands
/// still, what it returned last: then each entry is whole, but they may be of different moments.
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
