// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/matching.hpp"

#include <vector>

#include "platform/error.hpp"
#include "transport/matching/free_entries.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/peers/qos_compatibility.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::matching {
namespace {

/// Both ends of a potential match.
struct Pair {
  uint32_t publisher_slot;
  uint32_t subscription_slot;
  EndpointEntry & publisher;
  EndpointEntry & subscription;
};

/// True if the subscription gets the remaining history, false if only messages published from now
/// on.
bool wants_history(const EndpointEntry & publisher, const EndpointEntry & subscription) {
  return publisher.qos.durability == Durability::transient_local &&
         subscription.qos.durability == Durability::transient_local;
}

void count_match(Registry & registry, const Pair & pair) {
  for (EndpointEntry * end : {&pair.publisher, &pair.subscription}) {
    // Increment in this order: matched_of() loads the total first, so it never reports more current
    // matches than total ones.
    end->matched_current.fetch_add(1);
    end->matched_total.fetch_add(1);
    notify_event_watchers(registry, end->process);
  }
}

/// Invalidates references to the entry's former use. Returns the number of the last record that the
/// subscription does not want.
uint64_t begin_source(const Pair & pair, const TopicDsmHeader & dsm, SourceEntry & source) {
  source.incarnation.fetch_add(1, std::memory_order_release);
  source.topic_dsm.store(pair.publisher.block.word, std::memory_order_relaxed);
  source.topic_dsm_endpoint.store(pair.publisher_slot, std::memory_order_relaxed);
  source.topic_dsm_incarnation.store(pair.publisher.slot.incarnation, std::memory_order_relaxed);
  const LastPublished published = last_published(dsm);
  const uint64_t taken = wants_history(pair.publisher, pair.subscription) ? 0 : published.number;
  source.taken.store(taken, std::memory_order_relaxed);
  source.accounted.store(published.sequence, std::memory_order_relaxed);
  source.displaced.store(0, std::memory_order_relaxed);
  return taken;
}

/// Returns the block that has to be in hand first.
std::optional<NeededBlock> join(Registry & registry, const Pair & pair, BlockInHand * hand) {
  Cluster & publisher_cluster = registry.clusters().at(pair.publisher.cluster);
  Cluster & subscription_cluster = registry.clusters().at(pair.subscription.cluster);
  auto * const dsm = publisher_cluster.find<TopicDsmHeader>(pair.publisher.block.offset());
  auto * const header =
    subscription_cluster.find<SubscriptionHeader>(pair.subscription.block.offset());
  if (dsm == nullptr || header == nullptr) {
    throw Error(
      ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  FreeEntries entries(hand);
  const FreeEntries::Source free_source = entries.source(subscription_cluster, *header);
  ReaderEntry * const free_reader = entries.reader(publisher_cluster, *dsm);
  if (entries.needed()) {
    return entries.needed();
  }
  SourceEntry & source = *free_source.entry;
  ReaderEntry & reader = *free_reader;
  transfer::MatchRoom room(registry, pair.publisher, *dsm, subscription_cluster, hand);
  if (room.needed()) {
    return room.needed();
  }
  const uint64_t taken = begin_source(pair, *dsm, source);
  source.reader.store(publisher_cluster.ref_of(&reader).word, std::memory_order_relaxed);
  source.state.store(SourceState::joining, std::memory_order_release);
  // From here on the source leads to the room, should this process die.
  room.attach();

  // Release: a receive thread may still be reading the entry's former reader.
  reader.endpoint.store(pair.subscription_slot, std::memory_order_release);
  reader.subscription.store(pair.subscription.block.word, std::memory_order_release);
  reader.source.store(subscription_cluster.ref_of(&source).word, std::memory_order_release);
  reader.source_index.store(free_source.index, std::memory_order_release);
  reader.source_incarnation.store(source.incarnation.load(), std::memory_order_release);
  reader.active.store(1, std::memory_order_release);
  // From here on the publisher finds this reader: it checks `match_generation` after storing `last`
  // (seq_cst). A claim before this point would be invisible to the publisher, which could recycle
  // the record.
  dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
  source.state.store(SourceState::active, std::memory_order_seq_cst);
  header->source_generation.fetch_add(1, std::memory_order_seq_cst);

  // Deliver history, and messages published since `last` was first loaded.
  if (dsm->last.load(std::memory_order_seq_cst) > taken) {
    header->resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry, *header);
  }
  note_successor(pair.subscription);
  registry.tracer().note(
    TraceKind::match, pair.subscription_slot, 0,
    trace_endpoint(pair.publisher_slot, pair.publisher.slot.incarnation));
  count_match(registry, pair);
  return {};
}

void count_incompatible(Registry & registry, const Pair & pair, QosPolicy policy) {
  for (EndpointEntry * end : {&pair.publisher, &pair.subscription}) {
    end->incompatible_policy.store(static_cast<uint32_t>(policy));
    end->incompatible_total.fetch_add(1);
    notify_event_watchers(registry, end->process);
  }
}

void count_incompatible_type(Registry & registry, const Pair & pair) {
  for (EndpointEntry * end : {&pair.publisher, &pair.subscription}) {
    end->incompatible_types.fetch_add(1);
    notify_event_watchers(registry, end->process);
  }
}

/// Returns the block that has to be in hand first.
std::optional<NeededBlock> consider(Registry & registry, const Pair & pair, BlockInHand * hand) {
  if (
    pair.publisher.role != pair.subscription.role ||
    (pair.subscription.ignore_local != 0 && pair.publisher.process == pair.subscription.process)) {
    return {};
  }
  if (std::strcmp(pair.publisher.type, pair.subscription.type) != 0) {
    count_incompatible_type(registry, pair);
    return {};
  }
  const QosPolicy policy = last_incompatible_policy(pair.publisher.qos, pair.subscription.qos);
  if (policy != QosPolicy::none) {
    count_incompatible(registry, pair, policy);
    return {};
  }
  return join(registry, pair, hand);
}

bool is_other_end(const EndpointEntry & entry, const char * topic, EndpointKind kind) {
  return entry.kind != kind && std::strncmp(entry.topic, topic, name_bytes) == 0;
}

}  // namespace

void require_reach(Registry & registry, const std::string & topic, EndpointKind kind) {
  registry.for_each_of_bucket(topic.c_str(), Registry::Chain::live, [&](uint32_t slot) {
    const EntryCopy<EndpointEntry> other(registry.endpoints(), slot);
    if (is_other_end(*other, topic.c_str(), kind) && other.holds()) {
      registry.map_cluster((*other).cluster);
    }
  });
}

std::vector<Candidate> candidates_of(Registry & registry, uint32_t endpoint) {
  const EndpointEntry & own = registry.endpoints()[endpoint];
  std::vector<Candidate> candidates;
  registry.for_each_older(endpoint, [&](uint32_t slot, uint32_t incarnation) {
    const EntryCopy<EndpointEntry> other(registry.endpoints(), slot);
    if (is_other_end(*other, own.topic, own.kind) && other.holds()) {
      candidates.push_back({slot, incarnation, (*other).cluster});
    }
  });
  for (const Candidate & candidate : candidates) {
    registry.map_cluster(candidate.cluster);
  }
  return candidates;
}

std::optional<NeededBlock> connect_some(
  Registry & registry, uint32_t endpoint, std::vector<Candidate> & candidates, BlockInHand * hand) {
  EndpointEntry & own = registry.endpoints()[endpoint];
  for (; !candidates.empty(); candidates.pop_back()) {
    const Candidate candidate = candidates.back();
    EndpointEntry & other = registry.endpoints()[candidate.slot];
    const bool is_there = registry.endpoints().is_live(candidate.slot) &&
                          other.slot.incarnation.load() == candidate.incarnation;
    const Pair pair = own.kind == EndpointKind::publisher
                        ? Pair{endpoint, candidate.slot, own, other}
                        : Pair{candidate.slot, endpoint, other, own};
    const auto needed = is_there ? consider(registry, pair, hand) : std::nullopt;
    if (needed) {
      return needed;
    }
  }
  return std::nullopt;
}

}  // namespace manycore::matching
