// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Rebuilds the registry after the owner of its lock died. Part of Registry, defined up here because
// matches are derived state, too.
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/matching/matching.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

void Registry::mark_blocks_of(EndpointEntry & entry) noexcept {
  Cluster * const cluster = clusters_.find(entry.block.cluster());
  if (cluster == nullptr || !entry.block) {
    return;
  }
  uint64_t next = 0;
  uint64_t block_bytes = 0;
  if (entry.kind == EndpointKind::publisher) {
    auto * const dsm = cluster->find<TopicDsmHeader>(entry.block.offset());
    if (dsm == nullptr) {
      return;
    }
    cluster->mark_allocated(entry.block.offset(), sizeof(TopicDsmHeader));
    for (GenerationEntry & generation : dsm->generations) {
      if (generation.offset.load() != 0) {
        cluster->mark_allocated(generation.offset.load(), generation.extent_bytes());
      }
    }
    next = dsm->next_reader_block.load();
    block_bytes = sizeof(ReaderBlock);
  } else {
    auto * const subscription = cluster->find<SubscriptionHeader>(entry.block.offset());
    if (subscription == nullptr) {
      return;
    }
    cluster->mark_allocated(
      entry.block.offset(),
      sizeof(SubscriptionHeader) + (uint64_t{8} << (subscription->slot_count_log2 & 31)));
    next = subscription->first_source_block.load();
    block_bytes = sizeof(SourceBlock);
  }
  // Both kinds of continuation blocks start with the offset of the next one. The bound ends a
  // damaged chain.
  for (uint32_t i = 0; next != 0 && i < endpoint_capacity; ++i) {
    auto * const link = cluster->find<std::atomic<uint64_t>>(next, block_bytes);
    if (link == nullptr) {
      return;
    }
    cluster->mark_allocated(next, block_bytes);
    next = link->load();
  }
}

/// The last owner of the lock died at some instruction of a change. Primary state is the slots'
/// states, which change in one store; everything derived from them is built anew. All clusters are
/// mapped before: the map of one that is left out would go on without what was half allocated.
void Registry::repair() {
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    reach(id);
  }
  processes_.rebuild_free_list();
  nodes_.rebuild_free_list();
  endpoints_.rebuild_free_list();
  for (std::atomic<uint32_t> & bucket : header().topic_buckets) {
    bucket.store(nothing, std::memory_order_relaxed);
  }
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
  header().closing_count = 0;
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    EndpointEntry & entry = endpoints_[slot];
    const SlotState state = entry.slot.state.load(std::memory_order_acquire);
    if (state == SlotState::free) {
      continue;
    }
    mark_blocks_of(entry);
    if (state == SlotState::live) {
      link_endpoint(slot);
    } else {
      ++header().closing_count;
    }
  }
  matching::undo_half_matches(*this);
  matching::recount(*this);
}

}  // namespace manycore
