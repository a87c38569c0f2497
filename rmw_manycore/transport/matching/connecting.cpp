// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/connecting.hpp"

#include <optional>
#include <vector>

#include "platform/error.hpp"
#include "transport/matching/matching.hpp"
#include "transport/matching/spare_blocks.hpp"

namespace manycore::matching {
namespace {

/// False if there is no room, and no endpoint that is created at the same time was making the same
/// block: the match may find that.
bool make_block(
  Registry & registry, const Membership & membership, SpareBlock & spare,
  const spare_blocks::Needed & needed) {
  try {
    spare_blocks::make(registry, membership, spare, needed);
    return true;
  } catch (const Error & error) {
    if (error.code() != ErrorCode::no_space) {
      throw;
    }
    return spare_blocks::await_another(registry, spare, needed);
  }
}

}  // namespace

/// Another endpoint's block may have been attached since the match was tried, so a lack of room
/// is an error only the second time.
void connect(Registry & registry, const Membership & membership, uint32_t endpoint) {
  SpareBlock & spare = registry.endpoints()[endpoint].spare;
  std::vector<Candidate> candidates = candidates_of(registry, endpoint);
  bool lacks_room = false;
  while (!candidates.empty()) {
    std::optional<spare_blocks::Needed> needed;
    {
      const Registry::Lock lock(registry);
      membership.require();
      needed = connect_some(registry, endpoint, candidates);
    }
    if (needed && lacks_room) {
      spare_blocks::make(registry, membership, spare, *needed);
    }
    lacks_room = needed && !lacks_room && !make_block(registry, membership, spare, *needed);
  }
  spare_blocks::free_all(registry, membership, spare);
}

}  // namespace manycore::matching
