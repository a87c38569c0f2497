// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching.hpp"

#include "platform/error.hpp"
#include "transport/reader_table.hpp"
#include "transport/source_table.hpp"

namespace manycore::matching {
namespace {

/// Both ends of a possible match.
struct Pair {
  uint32_t publisher_slot;
  uint32_t subscription_slot;
  EndpointEntry & publisher;
  EndpointEntry & subscription;
};

void notify_process(Registry & registry, uint32_t process) {
  if (registry.processes().is_live(process)) {
    registry.processes()[process].wake.notify();
  }
}

void notify_event_watchers(Registry & registry, uint32_t process) {
  if (
    registry.processes().is_live(process) &&
    registry.processes()[process].wake.event_watchers.load() != 0) {
    registry.processes()[process].wake.notify();
  }
}

SourceEntry & free_source(
  Cluster & cluster, SubscriptionHeader & subscription, uint32_t & index_out) {
  SourceEntry * found = nullptr;
  std::atomic<uint64_t> * end = &subscription.first_source_block;
  uint32_t count = 0;
  visit_source_table(cluster, subscription, [&](SourceEntry & entry, uint32_t index) {
    count = index + 1;
    if (entry.state.load() != SourceState::free) {
      return false;
    }
    found = &entry;
    index_out = index;
    return true;
  });
  if (found != nullptr) {
    return *found;
  }
  if (count + sources_per_block > (1u << 14)) {
    throw Error(ErrorCode::no_space, "a subscription has more than 16,000 publishers");
  }
  while (end->load() != 0) {
    end = &cluster.find<SourceBlock>(end->load())->next;
  }
  SourceBlock & block = cluster.allocate_cleared<SourceBlock>();
  end->store(cluster.ref_of(&block).offset(), std::memory_order_release);
  index_out = count;
  return block.entries[0];
}

ReaderEntry & free_reader(Cluster & cluster, TopicDsmHeader & dsm) {
  ReaderEntry * found = nullptr;
  visit_reader_table(cluster, dsm, [&](ReaderEntry & entry) {
    found = entry.active.load() == 0 ? &entry : nullptr;
    return found != nullptr;
  });
  if (found != nullptr) {
    return *found;
  }
  std::atomic<uint64_t> * end = &dsm.next_reader_block;
  while (end->load() != 0) {
    end = &cluster.find<ReaderBlock>(end->load())->next;
  }
  ReaderBlock & block = cluster.allocate_cleared<ReaderBlock>();
  end->store(cluster.ref_of(&block).offset(), std::memory_order_release);
  return block.entries[0];
}

/// What a new match lets the subscription see: nothing published so far, or the history that is left.
bool wants_history(const EndpointEntry & publisher, const EndpointEntry & subscription) {
  return publisher.qos.durability == Durability::transient_local &&
         subscription.qos.durability == Durability::transient_local;
}

void join(Registry & registry, const Pair & pair) {
  Cluster & publisher_cluster = registry.clusters().at(pair.publisher.cluster);
  Cluster & subscription_cluster = registry.clusters().at(pair.subscription.cluster);
  auto * const dsm = publisher_cluster.find<TopicDsmHeader>(pair.publisher.block.offset());
  auto * const header =
    subscription_cluster.find<SubscriptionHeader>(pair.subscription.block.offset());
  if (dsm == nullptr || header == nullptr) {
    throw Error(ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  uint32_t index = 0;
  SourceEntry & source = free_source(subscription_cluster, *header, index);
  ReaderEntry & reader = free_reader(publisher_cluster, *dsm);
  const bool history = wants_history(pair.publisher, pair.subscription);

  source.incarnation.fetch_add(1, std::memory_order_relaxed);
  source.topic_dsm.store(pair.publisher.block.word, std::memory_order_relaxed);
  source.topic_dsm_endpoint.store(pair.publisher_slot, std::memory_order_relaxed);
  source.topic_dsm_incarnation.store(pair.publisher.slot.incarnation, std::memory_order_relaxed);
  const uint64_t taken = history ? 0 : dsm->last.load(std::memory_order_seq_cst);
  source.taken.store(taken, std::memory_order_relaxed);
  source.reader.store(publisher_cluster.ref_of(&reader).word, std::memory_order_relaxed);
  source.state.store(SourceState::joining, std::memory_order_release);

  reader.endpoint.store(pair.subscription_slot, std::memory_order_relaxed);
  reader.subscription.store(pair.subscription.block.word, std::memory_order_relaxed);
  reader.source.store(subscription_cluster.ref_of(&source).word, std::memory_order_relaxed);
  reader.source_index.store(index, std::memory_order_relaxed);
  reader.source_incarnation.store(source.incarnation.load(), std::memory_order_relaxed);
  reader.active.store(1, std::memory_order_release);
  // From here on the publisher finds this reader: it looks again after storing `last` (seq_cst). No claim may
  // come earlier, or the publisher could recycle a record under a reader it does not know.
  dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
  source.state.store(SourceState::active, std::memory_order_seq_cst);
  header->source_generation.fetch_add(1, std::memory_order_seq_cst);

  // History, or what was published between the first look at `last` and now.
  if (dsm->last.load(std::memory_order_seq_cst) > taken) {
    header->resync.store(1, std::memory_order_seq_cst);
    notify_process(registry, pair.subscription.process);
  }
  for (EndpointEntry * end : {&pair.publisher, &pair.subscription}) {
    end->matched_total.fetch_add(1);
    end->matched_current.fetch_add(1);
    notify_event_watchers(registry, end->process);
  }
}

void count_incompatible(Registry & registry, const Pair & pair, QosPolicy policy) {
  for (EndpointEntry * end : {&pair.publisher, &pair.subscription}) {
    end->incompatible_policy.store(static_cast<uint32_t>(policy));
    end->incompatible_total.fetch_add(1);
    notify_event_watchers(registry, end->process);
  }
}

void consider(Registry & registry, const Pair & pair) {
  if (
    pair.publisher.role != pair.subscription.role ||
    std::strcmp(pair.publisher.type, pair.subscription.type) != 0) {
    return;
  }
  if (pair.subscription.ignore_local != 0 && pair.publisher.process == pair.subscription.process) {
    return;
  }
  const QosPolicy policy = first_incompatible_policy(pair.publisher.qos, pair.subscription.qos);
  if (policy != QosPolicy::none) {
    count_incompatible(registry, pair, policy);
    return;
  }
  join(registry, pair);
}

void count_unmatched(Registry & registry, EndpointEntry & entry) {
  if (entry.matched_current.load() != 0) {
    entry.matched_current.fetch_sub(1);
  }
  notify_event_watchers(registry, entry.process);
}

/// The topic DSM of a source, or nullptr when its publisher's endpoint is gone and its memory may be another's.
TopicDsmHeader * topic_dsm_of(Registry & registry, const SourceEntry & source) {
  const uint32_t slot = source.topic_dsm_endpoint.load();
  if (slot >= registry.endpoints().high_water()) {
    return nullptr;
  }
  const Slot & publisher = registry.endpoints()[slot].slot;
  const bool there = publisher.state.load() != SlotState::free &&
                     publisher.incarnation == source.topic_dsm_incarnation.load();
  return there ? registry.clusters().find<TopicDsmHeader>(SegmentRef{source.topic_dsm.load()})
               : nullptr;
}

/// Takes the reader of a source off its topic DSM's reader table.
void detach_reader(Registry & registry, SourceEntry & source) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  auto * const reader = registry.clusters().find<ReaderEntry>(SegmentRef{source.reader.load()});
  if (dsm == nullptr || reader == nullptr) {
    return;
  }
  reader->active.store(0, std::memory_order_release);
  dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
  dsm->progress.fetch_add(1, std::memory_order_seq_cst);
  futex_wake_all(dsm->progress);  // a publisher that waited for this reader need not
}

void close_subscription(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const header = registry.clusters().find<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return;
  }
  visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
    const SourceState state = source.state.load();
    if (state != SourceState::active && state != SourceState::joining) {
      return false;
    }
    const uint32_t publisher = source.topic_dsm_endpoint.load();
    if (state == SourceState::active && topic_dsm_of(registry, source) != nullptr &&
        registry.endpoints().is_live(publisher)) {
      count_unmatched(registry, registry.endpoints()[publisher]);
    }
    source.state.store(SourceState::revoked, std::memory_order_seq_cst);
    detach_reader(registry, source);
    return false;
  });
}

/// A record that `reader` may still want, in any generation.
bool undelivered(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, const Gid & reader) {
  const uint64_t taken = source.taken.load(std::memory_order_acquire);
  if (taken >= dsm.last.load(std::memory_order_acquire)) {
    return false;
  }
  const auto role = static_cast<EndpointRole>(dsm.role);
  for (GenerationEntry & generation : dsm.generations) {
    const uint32_t count = generation.descriptor_count.load();
    auto * const descriptors = cluster.find<RecordDescriptor>(
      generation.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
    if (generation.first.load() == 0 || descriptors == nullptr) {
      continue;
    }
    for (uint32_t i = 0; i < count; ++i) {
      const bool live = descriptors[i].number.load(std::memory_order_acquire) > taken;
      if (live && (role != EndpointRole::reply || descriptors[i].correlation.client == reader)) {
        return true;
      }
    }
  }
  return false;
}

/// Hints of its last records may never have been pushed (`died`), or may have been displaced: readers that miss
/// something are told to look, so that the topic DSM does not wait for them for ever.
void close_publisher(Registry & registry, EndpointEntry & entry, bool died) {
  Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const dsm = registry.clusters().find<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return;
  }
  if (died) {
    dsm->phase.store(0, std::memory_order_seq_cst);  // the dead follow no references
  }
  if (dsm->orphan.load() != 0) {
    return;
  }
  for_each_reader(*cluster, *dsm, [&](ReaderEntry & reader) {
    const uint32_t slot = reader.endpoint.load();
    auto * const source = registry.clusters().find<SourceEntry>(SegmentRef{reader.source.load()});
    auto * const header =
      registry.clusters().find<SubscriptionHeader>(SegmentRef{reader.subscription.load()});
    if (!registry.endpoints().is_live(slot) || source == nullptr || header == nullptr) {
      return;
    }
    count_unmatched(registry, registry.endpoints()[slot]);
    if (undelivered(*cluster, *dsm, *source, registry.endpoints()[slot].gid)) {
      header->resync.store(1, std::memory_order_seq_cst);
      notify_process(registry, registry.endpoints()[slot].process);
    }
  });
  dsm->orphan.store(1, std::memory_order_seq_cst);
}

/// True when the cluster's receive thread follows no references that it loaded before now.
bool receive_threads_are_out(Registry & registry) {
  const uint64_t present = registry.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) == 0) {
      continue;
    }
    Cluster * const cluster = registry.clusters().find(id);
    if (cluster != nullptr && cluster->header().phase.load(std::memory_order_seq_cst) % 2 != 0) {
      return false;
    }
  }
  return true;
}

/// Takes the topic DSM away from a reader that is done with it; false while it is not.
bool revoke(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, ReaderEntry & reader) {
  auto * const source = registry.clusters().find<SourceEntry>(SegmentRef{reader.source.load()});
  auto * const header =
    registry.clusters().find<SubscriptionHeader>(SegmentRef{reader.subscription.load()});
  if (source == nullptr || header == nullptr) {
    return true;
  }
  if (source->state.load() == SourceState::active) {
    if (undelivered(cluster, dsm, *source, registry.endpoints()[reader.endpoint.load()].gid)) {
      return false;
    }
    // Dekker with the claim: the reader stores `reading` before it looks at the state.
    source->state.store(SourceState::revoked, std::memory_order_seq_cst);
  }
  if (source->reading.load(std::memory_order_seq_cst) != no_record) {
    return false;
  }
  source->state.store(SourceState::free, std::memory_order_release);
  header->source_generation.fetch_add(1, std::memory_order_release);
  reader.active.store(0, std::memory_order_release);
  return true;
}

void free_topic_dsm(Cluster & cluster, TopicDsmHeader & dsm) {
  for (GenerationEntry & generation : dsm.generations) {
    if (generation.first.load() != 0) {
      cluster.free(generation.offset.load(), generation.extent_bytes());
    }
  }
  uint64_t next = dsm.next_reader_block.load();
  while (next != 0) {
    const uint64_t block = next;
    next = cluster.find<ReaderBlock>(block)->next.load();
    cluster.free(block, sizeof(ReaderBlock));
  }
  cluster.free(cluster.ref_of(&dsm).offset(), sizeof dsm);
}

bool sweep_publisher(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const dsm = registry.clusters().find<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return true;
  }
  bool all_revoked = true;
  for_each_reader(*cluster, *dsm, [&](ReaderEntry & reader) {
    all_revoked = revoke(registry, *cluster, *dsm, reader) && all_revoked;
  });
  if (!all_revoked) {
    return false;
  }
  dsm->magic.store(0, std::memory_order_seq_cst);  // receive threads turn away from here on
  if (!receive_threads_are_out(registry)) {
    return false;
  }
  free_topic_dsm(*cluster, *dsm);
  return true;
}

/// True when the publisher behind `source` holds no references into the subscription.
bool publisher_is_out(Registry & registry, SourceEntry & source) {
  auto * const dsm = registry.clusters().find<TopicDsmHeader>(SegmentRef{source.topic_dsm.load()});
  return dsm == nullptr || dsm->magic.load() != topic_dsm_magic ||
         dsm->endpoint.load() != source.topic_dsm_endpoint.load() ||
         dsm->incarnation.load() != source.topic_dsm_incarnation.load() ||
         dsm->phase.load(std::memory_order_seq_cst) % 2 == 0;
}

bool sweep_subscription(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const header = registry.clusters().find<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return true;
  }
  bool out = receive_threads_are_out(registry);
  visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
    out = out && (source.state.load() == SourceState::free || publisher_is_out(registry, source));
    return !out;
  });
  if (!out) {
    return false;
  }
  header->magic.store(0);
  uint64_t next = header->first_source_block.load();
  while (next != 0) {
    const uint64_t block = next;
    next = cluster->find<SourceBlock>(block)->next.load();
    cluster->free(block, sizeof(SourceBlock));
  }
  cluster->free(
    entry.block.offset(),
    sizeof(SubscriptionHeader) + (uint64_t{8} << (header->slot_count_log2 & 31)));
  return true;
}

void undo_half_matches_of(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const header = registry.clusters().find<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return;
  }
  visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
    if (source.state.load() == SourceState::joining) {
      detach_reader(registry, source);
      source.state.store(SourceState::free, std::memory_order_seq_cst);
    }
    return false;
  });
}

}  // namespace

void connect(Registry & registry, uint32_t endpoint) {
  EndpointEntry & own = registry.endpoints()[endpoint];
  registry.for_each_of_topic(own.topic, [&](uint32_t slot, EndpointEntry & other) {
    if (other.kind == own.kind || !registry.endpoints().is_live(slot)) {
      return;
    }
    if (own.kind == EndpointKind::publisher) {
      consider(registry, {endpoint, slot, own, other});
    } else {
      consider(registry, {slot, endpoint, other, own});
    }
  });
}

void undo_half_matches(Registry & registry) {
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    EndpointEntry & entry = registry.endpoints()[slot];
    if (registry.endpoints().is_live(slot) && entry.kind == EndpointKind::subscription) {
      undo_half_matches_of(registry, entry);
    }
  }
}

void close(Registry & registry, uint32_t endpoint, bool died) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (entry.slot.state.exchange(SlotState::closing) == SlotState::live) {
    registry.unlink_endpoint(endpoint);
    ++registry.header().closing_count;
  }
  if (entry.kind == EndpointKind::publisher) {
    close_publisher(registry, entry, died);
  } else {
    close_subscription(registry, entry);
  }
}

void sweep(Registry & registry) {
  RegistryHeader & header = registry.header();
  for (uint32_t slot = 0; header.closing_count != 0 && slot < registry.endpoints().high_water();
       ++slot) {
    EndpointEntry & entry = registry.endpoints()[slot];
    if (entry.slot.state.load() != SlotState::closing) {
      continue;
    }
    const bool swept = entry.kind == EndpointKind::publisher ? sweep_publisher(registry, entry)
                                                             : sweep_subscription(registry, entry);
    if (swept) {
      entry.block = SegmentRef{};
      registry.endpoints().give_back(slot);
      --header.closing_count;
    }
  }
}

}  // namespace manycore::matching
