// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/joining.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/peers/endpoint_terms.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::joining {
namespace {

/// Endpoints between which records are transferred.
struct Pair {
  uint32_t publisher;
  uint32_t publisher_incarnation;
  uint32_t subscription;
  uint32_t subscription_incarnation;
};

bool is_there(Registry & registry, uint32_t slot, uint32_t incarnation) {
  return registry.endpoints().is_live(slot) &&
         registry.endpoints()[slot].slot.incarnation.load() == incarnation;
}

/// Attaches room for the publisher's records if it is still wanted and none is there. Returns the
/// block that has to be in hand first.
std::optional<NeededBlock> attach(Registry & registry, const Pair & pair, BlockInHand * hand) {
  if (
    !is_there(registry, pair.publisher, pair.publisher_incarnation) ||
    !is_there(registry, pair.subscription, pair.subscription_incarnation)) {
    return std::nullopt;
  }
  const EndpointEntry & publisher = registry.endpoints()[pair.publisher];
  Cluster & from = registry.clusters().at(publisher.cluster);
  Cluster & to = registry.clusters().at(registry.endpoints()[pair.subscription].cluster);
  auto * const dsm = from.find<TopicDsmHeader>(publisher.block.offset());
  if (dsm == nullptr) {
    throw Error(
      ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  transfer::MatchRoom room(registry, publisher, *dsm, to, hand);
  if (room.needed()) {
    return room.needed();
  }
  room.attach();
  registry.raise_changes(publisher.topic_hash);
  return std::nullopt;
}

/// False if there is no room, and no endpoint that is created at the same time was making the same
/// block: the next attempt may find that.
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

/// Another endpoint's block may have been attached since the last attempt, so a lack of room is an
/// error only the second time.
void make_room(Registry & registry, const Membership & membership, const Pair & pair) {
  std::optional<BlockInHand> hand;
  bool lacks_room = false;
  while (true) {
    std::optional<NeededBlock> needed;
    {
      const Registry::Lock lock(registry);
      membership.require();
      needed = attach(registry, pair, hand ? &*hand : nullptr);
    }
    if (!needed) {
      return;
    }
    if (!hand) {
      hand.emplace(registry);
    }
    if (lacks_room) {
      hand->make(membership, *needed);
    }
    lacks_room = !lacks_room && !make_block(*hand, membership, *needed);
  }
}

/// An endpoint that the new one is matched with, or is found incompatible with.
struct Other {
  uint32_t slot;
  uint32_t incarnation;
  uint32_t process;
  uint32_t cluster;
  bool is_matched;
  bool has_history;
};

std::vector<Other> others_of(Registry & registry, const EndpointEntry & entry) {
  const EndpointTerms own(entry);
  std::vector<Other> others;
  registry.walk_bucket(own.topic_hash, [&](uint32_t slot, uint32_t incarnation) {
    const EntryCopy<EndpointEntry> copy(registry.endpoints(), slot);
    const Fit::Kind fit = fit_of(own, *copy).kind;
    if (fit != Fit::Kind::strangers && copy.incarnation() == incarnation && copy.holds()) {
      others.push_back(
        {slot, incarnation, (*copy).process.load(), (*copy).cluster, fit == Fit::Kind::matched,
         (*copy).qos.durability == Durability::transient_local});
    }
    return true;
  });
  return others;
}

void trace_match(
  Registry & registry, uint32_t endpoint, const EndpointEntry & entry, const Other & other) {
  const bool is_publisher = entry.kind == EndpointKind::publisher;
  const uint64_t publisher = is_publisher ? trace_endpoint(endpoint, entry.slot.incarnation.load())
                                          : trace_endpoint(other.slot, other.incarnation);
  registry.tracer().note(TraceKind::match, is_publisher ? other.slot : endpoint, 0, publisher);
}

/// A new subscription looks for the history of publishers that are there already: they do not know
/// of it before they publish.
void look_for_history(
  Registry & registry, const EndpointEntry & entry, const std::vector<Other> & others) {
  const bool has_history = entry.kind == EndpointKind::subscription &&
                           entry.qos.durability == Durability::transient_local &&
                           std::any_of(others.begin(), others.end(), [](const Other & other) {
                             return other.is_matched && other.has_history;
                           });
  auto * const header =
    has_history ? registry.clusters().find<SubscriptionHeader>(entry.block) : nullptr;
  if (header != nullptr) {
    header->resync.store(1, std::memory_order_seq_cst);
  }
}

}  // namespace

void require_reach(Registry & registry, const std::string & topic, EndpointKind kind) {
  registry.for_each_of_bucket(topic.c_str(), [&](uint32_t slot) {
    const EntryCopy<EndpointEntry> other(registry.endpoints(), slot);
    if (
      (*other).kind != kind && std::strncmp((*other).topic, topic.c_str(), name_bytes) == 0 &&
      other.holds()) {
      registry.map_cluster((*other).cluster);
    }
  });
}

void join(Registry & registry, const Membership & membership, uint32_t endpoint) {
  const EndpointEntry & entry = registry.endpoints()[endpoint];
  const uint32_t incarnation = entry.slot.incarnation.load();
  const bool is_publisher = entry.kind == EndpointKind::publisher;
  const std::vector<Other> others = others_of(registry, entry);
  for (const Other & other : others) {
    if (other.is_matched && entry.transfer != Transfer::dsm && other.cluster != entry.cluster) {
      registry.map_cluster(other.cluster);
      const Pair pair = is_publisher ? Pair{endpoint, incarnation, other.slot, other.incarnation}
                                     : Pair{other.slot, other.incarnation, endpoint, incarnation};
      make_room(registry, membership, pair);
    }
  }
  look_for_history(registry, entry, others);
  for (const Other & other : others) {
    if (other.is_matched) {
      trace_match(registry, endpoint, entry, other);
    }
    notify_event_watchers(registry, other.process);
  }
  if (!others.empty()) {
    notify_event_watchers(registry, entry.process);
  }
}

}  // namespace manycore::joining
