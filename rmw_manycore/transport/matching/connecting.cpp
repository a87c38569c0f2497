// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/connecting.hpp"

#include <optional>
#include <set>
#include <vector>

#include "platform/error.hpp"
#include "transport/matching/matching.hpp"

namespace manycore::matching {
namespace {

/// False if there is no room, and no endpoint that is created at the same time was making the same
/// block: the match may find that.
bool make_block(BlockInHand & hand, const Membership & membership, const NeededBlock & needed) {
  try {
    hand.make(membership, needed);
    return true;
  } catch (const Error & error) {
    if (error.code() != ErrorCode::no_space) {
      throw;
    }
    return hand.await_another(needed);
  }
}

/// Both ends of a match may need another block of their tables.
std::set<uint32_t> clusters_of(const EndpointEntry & own, const std::vector<Candidate> & others) {
  std::set<uint32_t> clusters{own.cluster};
  for (const Candidate & other : others) {
    clusters.insert(other.cluster);
  }
  return clusters;
}

}  // namespace

/// Another endpoint's block may have been attached since the match was tried, so a lack of room
/// is an error only the second time.
void connect(Registry & registry, const Membership & membership, uint32_t endpoint) {
  EndpointEntry & own = registry.endpoints()[endpoint];
  std::vector<Candidate> candidates = candidates_of(registry, endpoint);
  const std::set<uint32_t> clusters = clusters_of(own, candidates);
  std::optional<BlockInHand> hand;
  bool lacks_room = false;
  while (!candidates.empty()) {
    for (const uint32_t id : clusters) {
      if (Cluster * const cluster = registry.clusters().find(id); cluster != nullptr) {
        cluster->back_ahead();
      }
    }
    std::optional<NeededBlock> needed;
    {
      const Registry::Lock lock(registry);
      membership.require();
      needed = connect_some(registry, endpoint, candidates, hand ? &*hand : nullptr);
    }
    if (needed && !hand) {
      hand.emplace(registry);
    }
    if (needed && lacks_room) {
      hand->make(membership, *needed);
    }
    lacks_room = needed && !lacks_room && !make_block(*hand, membership, *needed);
  }
}

}  // namespace manycore::matching
