// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/matching/turn.hpp"
#include "transport/matching/undelivered.hpp"

namespace manycore::sweeping {

/// Decides whether a subscription still wants messages of a publisher that is gone. A KEEP_LAST
/// subscription does if the newest of them is among its newest `depth` records over all its
/// sources, as a resync would cut them. Visits other sources until `depth` newer records are found,
/// in as many turns as needed. The caller holds the registry lock in each turn, so no publisher
/// frees a generation meanwhile.
class WantedSources {
public:
  explicit WantedSources(Registry & registry) noexcept : registry_(registry) {}

  /// Nothing if the turn ended before the answer was found: ask for the same reader in the next
  /// turn.
  std::optional<bool> contain(const closing::OrphanReader & reader, Turn & turn);

private:
  /// Progress of the check for one subscription.
  struct Look {
    uint32_t endpoint;  ///< slot of the subscription
    uint32_t incarnation;
    uint64_t taken;  ///< messages taken or expired when the check began
    closing::Undelivered record;
    uint32_t next;   ///< index of the first source not visited yet
    uint32_t newer;  ///< newer records found so far
  };

  /// Continues the last check if it is for this reader.
  Look look_at(const closing::OrphanReader & reader, const closing::Undelivered & newest) const;
  /// False if the turn ended before the last source.
  bool count_newer(Look & look, const closing::OrphanReader & reader, Turn & turn) const;

  Registry & registry_;
  std::optional<Look> last_;  ///< check that is not complete
};

}  // namespace manycore::sweeping
