// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "transport/matching/turn.hpp"
#include "transport/matching/undelivered.hpp"

namespace manycore::sweeping {

struct HintedSources;

/// Decides whether a subscription still wants messages of a publisher that is gone, and can get
/// them. A KEEP_LAST subscription wants them if the newest of them is among its newest `depth`
/// records over all its sources, as a resync would cut them, or if its queue has a hint of one.
/// Visits other sources until `depth` newer records are found, in as many turns as needed: first
/// those of which the queue has hints, as most looks need no more. The caller holds the registry
/// lock in each turn, so no publisher frees a generation during a turn.
class WantedSources {
public:
  explicit WantedSources(Registry & registry) noexcept : registry_(registry) {}

  /// Nothing if the turn ended before the answer was found: ask for the same reader in the next
  /// turn.
  std::optional<bool> contain(const closing::OrphanReader & reader, Turn & turn);
  /// True if the last check is not complete.
  bool is_looking() const noexcept { return look_.has_value(); }

private:
  /// Progress of the check for one reader.
  struct Look {
    uint32_t endpoint;  ///< slot of the subscription
    uint32_t incarnation;
    uint32_t source;  ///< index of the reader's own source
    uint32_t source_incarnation;
    uint64_t taken;           ///< messages taken or expired when the check began
    DescriptorPlace place{};  ///< of the search in progress
    bool knows_newest = false;
    std::optional<closing::Undelivered> newest{};  ///< of the reader's own records
    uint32_t hint_turns_left = 2;   ///< to look at the hints; 0 once that is done, or given up
    uint32_t next = 0;              ///< index of the first source not visited yet
    closing::NewerCount in_next{};  ///< what is found in that source
    uint32_t newer = 0;             ///< newer records found in earlier ones, or by hints
    std::optional<bool> is_wanted{};

    bool is_at(const closing::OrphanReader & reader) const noexcept;
    static Look at(const closing::OrphanReader & reader) noexcept;
  };

  std::optional<bool> is_among_newest(
    Look & look, const closing::OrphanReader & reader, Turn & turn) const;
  /// Records of a source that are newer; nothing if the turn ended before.
  std::optional<uint32_t> newer_in(
    Look & look, SourceEntry & source, uint32_t index, Turn & turn) const;
  /// 0 if those found within this turn are fewer than `depth`: to be counted with all others.
  uint32_t newer_in_hinted(
    Look & look, const closing::OrphanReader & reader, const HintedSources & hinted,
    Turn & turn) const;
  /// False if the turn ended before the last source.
  bool count_newer(Look & look, const closing::OrphanReader & reader, Turn & turn) const;
  /// True if what the reader has not taken is there or will come.
  std::optional<bool> is_to_be_had(
    Look & look, const closing::OrphanReader & reader, Turn & turn) const;

  Registry & registry_;
  std::optional<Look> look_;  ///< check that is not complete
};

}  // namespace manycore::sweeping
