// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/joining.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/peers/endpoint_terms.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::joining {
namespace {

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
      transfer::make_room(
        registry, membership,
        is_publisher ? transfer::Ends{endpoint, incarnation, other.slot, other.incarnation}
                     : transfer::Ends{other.slot, other.incarnation, endpoint, incarnation});
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
