// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/matching.hpp"

#include <vector>

#include "platform/error.hpp"
#include "transport/matching/free_entries.hpp"
#include "transport/matching/match_in_hand.hpp"
#include "transport/matching/turn.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/qos/qos_compatibility.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/transfer/landing.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore::matching {
namespace {

constexpr uint64_t steps_of_a_candidate = 3;
constexpr uint64_t steps_of_a_match = 7;

/// Both ends of a potential match.
struct Pair {
  uint32_t publisher_slot;
  uint32_t subscription_slot;
  EndpointEntry & publisher;
  EndpointEntry & subscription;
  SpareBlock & spare;  ///< of the new one
};

/// What a candidate has come to.
struct Considered {
  bool is_done = true;
  std::optional<spare_blocks::Needed> needed{};
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

/// Gives the publisher's records a place in the subscription's cluster, where they are transferred.
/// A former landing that is being freed is freed first: nothing follows references to it any more.
Considered find_place(
  Registry & registry, const Pair & pair, TopicDsmHeader & dsm, Cluster & receiver, Turn & turn) {
  const landings::Place place =
    landings::find_place(registry, pair.publisher, dsm, receiver, pair.spare);
  if (place == landings::Place::ready) {
    return {};
  }
  const uint64_t bytes = landing_bytes(dsm);
  if (place == landings::Place::missing) {
    const uint64_t data_bytes = dsm.generations[0].data_bytes.load(std::memory_order_relaxed);
    return {
      false, spare_blocks::Needed{SpareUse::landing, receiver.id(), bytes, bytes - data_bytes}};
  }
  if (turn.begin_freeing(bytes)) {
    landings::free_piece_of_retired(registry.clusters().at(pair.publisher.cluster), dsm, receiver);
  } else {
    turn.end();
  }
  return {false};
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

Considered join(Registry & registry, const Pair & pair, Turn & turn) {
  turn.spend(steps_of_a_match);
  Cluster & publisher_cluster = registry.clusters().at(pair.publisher.cluster);
  Cluster & subscription_cluster = registry.clusters().at(pair.subscription.cluster);
  auto * const dsm = publisher_cluster.find<TopicDsmHeader>(pair.publisher.block.offset());
  auto * const header =
    subscription_cluster.find<SubscriptionHeader>(pair.subscription.block.offset());
  if (dsm == nullptr || header == nullptr) {
    throw Error(
      ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  FreeEntries entries(pair.spare, turn);
  const FreeEntries::Source free_source = entries.source(subscription_cluster, *header);
  ReaderEntry * const free_reader = entries.reader(publisher_cluster, *dsm);
  if (entries.needed()) {
    return {false, entries.needed()};
  }
  SourceEntry & source = *free_source.entry;
  ReaderEntry & reader = *free_reader;
  if (const Considered found = find_place(registry, pair, *dsm, subscription_cluster, turn);
      !found.is_done) {
    return found;
  }
  match_in_hand::note(registry.header(), pair.publisher_slot, pair.subscription_slot);
  const uint64_t taken = begin_source(pair, *dsm, source);
  source.reader.store(publisher_cluster.ref_of(&reader).word, std::memory_order_relaxed);
  source.state.store(SourceState::joining, std::memory_order_release);
  // From here on the source leads to the landing, should this process die.
  landings::attach(publisher_cluster, *dsm, subscription_cluster, pair.spare);

  // Release: a receive thread may still be reading the entry's former reader.
  reader.endpoint.store(pair.subscription_slot, std::memory_order_release);
  reader.subscription.store(pair.subscription.block.word, std::memory_order_release);
  reader.source.store(subscription_cluster.ref_of(&source).word, std::memory_order_release);
  reader.source_index.store(free_source.index, std::memory_order_release);
  reader.source_incarnation.store(source.incarnation.load(), std::memory_order_release);
  reader.active.store(1, std::memory_order_release);
  landings::count_reader(publisher_cluster, *dsm, subscription_cluster.id());
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

Considered consider(Registry & registry, const Pair & pair, Turn & turn) {
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
  return join(registry, pair, turn);
}

bool is_other_end(const EndpointEntry & entry, const char * topic, EndpointKind kind) {
  return entry.kind != kind && std::strncmp(entry.topic, topic, name_bytes) == 0;
}

}  // namespace

void require_reach(Registry & registry, const std::string & topic, EndpointKind kind) {
  registry.for_each_of_bucket(topic.c_str(), [&](uint32_t slot) {
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

std::optional<spare_blocks::Needed> connect_some(
  Registry & registry, uint32_t endpoint, std::vector<Candidate> & candidates) {
  EndpointEntry & own = registry.endpoints()[endpoint];
  for (Turn turn; !turn.is_over() && !candidates.empty();) {
    const Candidate candidate = candidates.back();
    EndpointEntry & other = registry.endpoints()[candidate.slot];
    const bool is_there = registry.endpoints().is_live(candidate.slot) &&
                          other.slot.incarnation.load() == candidate.incarnation;
    const Pair pair = own.kind == EndpointKind::publisher
                        ? Pair{endpoint, candidate.slot, own, other, own.spare}
                        : Pair{candidate.slot, endpoint, other, own, own.spare};
    turn.spend(steps_of_a_candidate);
    const Considered considered = is_there ? consider(registry, pair, turn) : Considered{};
    if (considered.needed) {
      return considered.needed;
    }
    if (considered.is_done) {
      candidates.pop_back();
    }
  }
  return std::nullopt;
}

}  // namespace manycore::matching
