// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "transport/matching/turn.hpp"
#include "transport/matching/undelivered.hpp"

namespace manycore::sweeping {

/// The sources from which each subscription is still to get messages. KEEP_LAST: those that hold
/// any of its newest `depth` records, over all its sources, as a resync would cut them. Looks into
/// a subscription's sources once while it lives, by as many turns as it takes; the caller holds the
/// registry lock in each, under which no publisher frees a generation.
class WantedSources {
public:
  explicit WantedSources(Registry & registry) noexcept : registry_(registry) {}

  /// Nothing when the turn was over before all sources were looked into: to be asked again.
  std::optional<bool> contain(const closing::OrphanReader & reader, Turn & turn);

private:
  /// At the sources of one subscription.
  struct Look {
    uint32_t incarnation = 0;  ///< of the subscription's slot
    uint64_t taken = 0;        ///< messages, when the look began
    uint32_t next = 0;         ///< index of the first source that it has not come to
    bool is_done = false;
    std::vector<closing::Undelivered> newest;  ///< `depth` at most, once in a while more
    std::set<uint32_t> sources;                ///< indices; once done
  };

  Look & look_of(const closing::OrphanReader & reader);
  void go_on(Look & look, const closing::OrphanReader & reader, Turn & turn);

  Registry & registry_;
  std::map<uint32_t, Look> looks_;  ///< by the subscription's slot
};

}  // namespace manycore::sweeping
