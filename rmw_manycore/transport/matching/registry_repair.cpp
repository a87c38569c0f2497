// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Registry: rebuilds derived state after the owner of its lock died. Defined in this layer
// because match counts are derived state as well.
#include <algorithm>
#include <vector>

#include "transport/matching/match_in_hand.hpp"
#include "transport/matching/spare_blocks.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/registry.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/landing.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore {

void Registry::mark_blocks_of(EndpointEntry & entry) noexcept {
  Cluster * const cluster = clusters_.find(entry.block.cluster());
  spare_blocks::mark(clusters_, entry.spare);
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
    landings::mark_all(clusters_, *cluster, *dsm);
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
    spare_blocks::mark(clusters_, processes_[slot].spare);
    Cluster * const cluster = clusters_.find(processes_[slot].cluster);
    if (cluster != nullptr) {
      cluster->mark_charged(processes_[slot].charged_bytes);
    }
  }
  header().closing.clear();
  header().closing_count = 0;
  std::vector<uint32_t> live;
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    EndpointEntry & entry = endpoints_[slot];
    const SlotState state = entry.slot.state.load(std::memory_order_acquire);
    if (state == SlotState::free) {
      continue;
    }
    mark_blocks_of(entry);
    if (state == SlotState::live) {
      live.push_back(slot);
    } else {
      header().closing.add(slot);
      ++header().closing_count;
    }
  }
  // Link in order of age: a concurrent walk to older endpoints continues.
  std::sort(live.begin(), live.end(), [this](uint32_t a, uint32_t b) {
    return header().last_order - endpoints_[a].order > header().last_order - endpoints_[b].order;
  });
  for (const uint32_t slot : live) {
    link_endpoint(slot);
  }
  match_in_hand::repair(*this);
}

}  // namespace manycore
