// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/matching/turn.hpp"
#include "transport/matching/undelivered.hpp"

namespace manycore::sweeping {

/// Whether a subscription is still to get messages of a publisher that is gone. KEEP_LAST: if the
/// newest of them is among its newest `depth` records, over all its sources, as a resync would cut
/// them. Looks at other sources until `depth` newer records are found, by as many turns as it
/// takes; the caller holds the registry lock in each, under which no publisher frees a generation.
class WantedSources {
public:
  explicit WantedSources(Registry & registry) noexcept : registry_(registry) {}

  /// Nothing when the turn was over before the answer was found: ask for the same reader next.
  std::optional<bool> contain(const closing::OrphanReader & reader, Turn & turn);

private:
  /// At the sources of one subscription.
  struct Look {
    uint32_t endpoint;  ///< slot of the subscription
    uint32_t incarnation;
    uint64_t taken;  ///< messages, when the look began
    closing::Undelivered record;
    uint32_t next;   ///< index of the first source that it has not come to
    uint32_t newer;  ///< records found
  };

  /// Goes on with the last look, if it is at this reader.
  Look look_at(const closing::OrphanReader & reader, const closing::Undelivered & newest) const;
  /// False when the turn was over before the end.
  bool count_newer(Look & look, const closing::OrphanReader & reader, Turn & turn) const;

  Registry & registry_;
  std::optional<Look> last_;  ///< one that no turn has finished
};

}  // namespace manycore::sweeping
