// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Registry: rebuilds derived state after the owner of its lock died. Defined in this layer
// because match counts are derived state as well.
#include <algorithm>
#include <vector>

#include "transport/matching/detaching.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/registry.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {
namespace matches {
namespace {

/// Calls `visit(EndpointEntry &, const Cluster &, Header &)` for each endpoint of a kind that has
/// memory.
template<typename Header, typename Visit>
void for_each_endpoint(Registry & registry, EndpointKind kind, Visit visit) {
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    EndpointEntry & entry = registry.endpoints()[slot];
    const Cluster * const cluster = registry.clusters().find(entry.block.cluster());
    auto * const header = registry.clusters().find<Header>(entry.block);
    if (
      entry.kind == kind && has_memory(entry.slot.state.load(std::memory_order_acquire)) &&
      cluster != nullptr && header != nullptr) {
      visit(entry, *cluster, *header);
    }
  }
}

/// Undoes a match that is made by half. Not `free`: the publisher may have seen the reader, so its
/// phase must be checked through this entry when the subscription is freed.
void undo_half(Registry & registry, SourceEntry & source, uint32_t receiver) {
  detach_reader(registry, source, receiver);
  source.state.store(SourceState::revoked, std::memory_order_seq_cst);
}

/// A publisher that is gone is not counted once all its readers are notified.
void count_sources(
  Registry & registry, EndpointEntry & entry, const Cluster & cluster,
  SubscriptionHeader & subscription) {
  uint64_t count = 0;
  visit_source_table(cluster, subscription, [&](SourceEntry & source, uint32_t) {
    const SourceState state = source.state.load();
    if (state == SourceState::joining) {
      undo_half(registry, source, entry.cluster);
    } else if (state == SourceState::active) {
      const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
      if (dsm != nullptr && dsm->orphan.load() == 0) {
        ++count;
        registry.endpoints()[source.topic_dsm_endpoint.load()].matched_current.fetch_add(1);
      }
    }
    return false;
  });
  entry.matched_current.store(count);
}

/// Undoes the match that was being made, and counts all matches anew.
void repair(Registry & registry) {
  for_each_endpoint<TopicDsmHeader>(
    registry, EndpointKind::publisher,
    [](EndpointEntry & entry, const Cluster &, TopicDsmHeader &) {
      entry.matched_current.store(0);
    });
  for_each_endpoint<SubscriptionHeader>(
    registry, EndpointKind::subscription,
    [&](EndpointEntry & entry, const Cluster & cluster, SubscriptionHeader & subscription) {
      count_sources(registry, entry, cluster, subscription);
    });
}

}  // namespace
}  // namespace matches

void Registry::mark_blocks_of(EndpointEntry & entry) noexcept {
  Cluster * const cluster = clusters_.find(entry.block.cluster());
  if (cluster == nullptr || !entry.block) {
    return;
  }
  const auto mark = [&](uint64_t offset, uint64_t bytes) {
    cluster->mark_allocated(offset, bytes);
  };
  if (entry.kind == EndpointKind::publisher) {
    auto * const dsm = cluster->find<TopicDsmHeader>(entry.block.offset());
    if (dsm == nullptr) {
      return;
    }
    mark(entry.block.offset(), header_bytes(*dsm));
    transfer::mark(clusters_, *cluster, *dsm);
    for (GenerationEntry & generation : dsm->generations) {
      if (generation.offset.load() != 0) {
        mark(generation.offset.load(), generation.extent_bytes());
      }
    }
    further_readers(*cluster, *dsm).visit_memory(mark);
    dsm->free_reader_from = 0;
  } else {
    auto * const subscription = cluster->find<SubscriptionHeader>(entry.block.offset());
    if (subscription == nullptr) {
      return;
    }
    mark(entry.block.offset(), block_bytes(*subscription));
    source_table(*cluster, *subscription).visit_memory(mark);
    subscription->free_source_from = 0;
  }
}

/// Nothing of an endpoint's memory is read here: others may repair and free it meanwhile. What was
/// freed may then be backed again, until it is allocated.
void Registry::prepare_repair() {
  constexpr uint64_t head_bytes = std::max(sizeof(TopicDsmHeader), sizeof(SubscriptionHeader));
  memory_.populate(0, sizeof(RegistryHeader));
  processes_.populate();
  nodes_.populate();
  endpoints_.populate();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if (const Cluster * const cluster = map_cluster(id)) {
      cluster->populate_map();
    }
  }
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    const SegmentRef block = (*EntryCopy<EndpointEntry>(endpoints_, slot)).block;
    if (const Cluster * const cluster = block ? clusters_.find(block.cluster()) : nullptr) {
      cluster->populate(block.offset(), head_bytes);
    }
  }
}

/// The last owner of the lock died at some instruction of a change. The slots' states are primary,
/// and each changes in a single store; everything derived from them is rebuilt. All clusters are
/// mapped first: the map of an omitted cluster would keep half-made allocations.
void Registry::repair() {
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    map_cluster(id);
  }
  processes_.rebuild_free_list();
  nodes_.rebuild_free_list();
  endpoints_.rebuild_free_list();
  const uint64_t present = header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) != 0 && clusters_.find(id) != nullptr) {
      clusters_.find(id)->forget_allocations();
    }
  }
  for (uint32_t slot = 0; slot < processes_.high_water(); ++slot) {
    if (!processes_.is_live(slot)) {
      continue;
    }
    Cluster * const cluster = clusters_.find(processes_[slot].cluster);
    if (cluster != nullptr) {
      cluster->mark_charged(processes_[slot].charged_bytes);
    }
  }
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    if (endpoints_[slot].slot.state.load(std::memory_order_acquire) != SlotState::free) {
      mark_blocks_of(endpoints_[slot]);
    }
  }
  mark_blocks_in_hands();
  link_all_endpoints();
  matches::repair(*this);
  // The dead owner may have changed a row, and not raised them.
  for (TopicBucket & bucket : header().topic_buckets) {
    bucket.changes.fetch_add(1, std::memory_order_seq_cst);
  }
}

/// A block that its endpoint still leads to was about to change hands: it stays with the endpoint.
void Registry::mark_blocks_in_hands() noexcept {
  for (Hand & hand : header().hands) {
    const SegmentRef block{hand.block.load()};
    Cluster * const cluster = block ? clusters_.find(block.cluster()) : nullptr;
    if (cluster == nullptr) {
      continue;
    }
    if (cluster->is_allocated(block.offset())) {
      hand.block.store(0);
    } else {
      cluster->mark_allocated(block.offset(), hand.bytes.load());
    }
  }
}

std::vector<uint32_t> Registry::endpoints_from_oldest(Chain chain) const {
  std::vector<uint32_t> found;
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    const SlotState state = endpoints_[slot].slot.state.load(std::memory_order_acquire);
    const bool is_orphan = state != SlotState::free && state != SlotState::live &&
                           state != SlotState::unreachable &&
                           endpoints_[slot].kind == EndpointKind::publisher;
    if (chain == Chain::live ? state == SlotState::live : is_orphan) {
      found.push_back(slot);
    }
  }
  const uint32_t last = header().last_order;
  std::sort(found.begin(), found.end(), [&](uint32_t a, uint32_t b) {
    return last - endpoints_[a].order > last - endpoints_[b].order;
  });
  return found;
}

/// In the order in which they were linked, and each bucket last: a concurrent walk misses none,
/// because the buckets lead to what the dead owner left, which is whole, and each link leads to an
/// older endpoint.
void Registry::link_all_of(Chain chain) {
  std::vector<uint32_t> youngest(topic_bucket_count, nothing);
  for (const uint32_t slot : endpoints_from_oldest(chain)) {
    uint32_t & next = youngest[endpoints_[slot].topic_hash % topic_bucket_count];
    link_before(slot, next);
    next = slot;
  }
  for (uint32_t bucket = 0; bucket < topic_bucket_count; ++bucket) {
    bucket_of(bucket, chain).store(youngest[bucket], std::memory_order_release);
  }
}

/// The live endpoints first: one that is closing may still be among them, and leads to older ones
/// until it gets its place among the orphans.
void Registry::link_all_endpoints() {
  RegistryHeader & head = header();
  head.closing.clear();
  head.closing_count = 0;
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    const SlotState state = endpoints_[slot].slot.state.load(std::memory_order_acquire);
    if (state != SlotState::free && state != SlotState::live) {
      head.closing.add(slot);
      ++head.closing_count;
    }
  }
  link_all_of(Chain::live);
  link_all_of(Chain::orphans);
}

}  // namespace manycore
