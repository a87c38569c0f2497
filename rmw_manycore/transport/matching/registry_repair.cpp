// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Registry: rebuilds derived state after the owner of its lock died. Defined in this layer
// because it knows what endpoints lead to.
#include <algorithm>
#include <vector>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/registry.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/chunk_table.hpp"
#include "transport/topic_dsm/seat_table.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {
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
    further_seats(*cluster, *dsm).visit_memory(mark);
    chunks_of(*cluster, *dsm).visit_memory(mark);
    chunks_of(*cluster, *dsm).visit([&](ChunkEntry & chunk) {
      if (chunk.offset.load() != 0) {
        mark(chunk.offset.load(), chunk.bytes.load());
      }
      return false;
    });
  } else {
    auto * const subscription = cluster->find<SubscriptionHeader>(entry.block.offset());
    if (subscription == nullptr) {
      return;
    }
    mark(entry.block.offset(), block_bytes(*subscription));
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
  // The dead owner may have changed a row, and neither raised them nor woken its peers.
  raise_all_changes();
  for (uint32_t slot = 0; slot < processes_.high_water(); ++slot) {
    notify_event_watchers(*this, slot);
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

/// The links are stored from the oldest endpoint on, the buckets last: at any moment each link
/// leads to older endpoints of its bucket, and a walk that begins meanwhile finds what the dead
/// owner left (docs/model/chains.pml).
void Registry::link_all_endpoints() {
  RegistryHeader & head = header();
  head.closing.clear();
  head.closing_count = 0;
  std::vector<uint32_t> linked;
  for (uint32_t slot = 0; slot < endpoints_.high_water(); ++slot) {
    const SlotState state = endpoints_[slot].slot.state.load(std::memory_order_acquire);
    if (is_closed(state)) {
      head.closing.add(slot);
      ++head.closing_count;
    }
    if (is_linked(state)) {
      linked.push_back(slot);
    }
  }
  std::sort(linked.begin(), linked.end(), [&](uint32_t a, uint32_t b) {
    return head.last_order - endpoints_[a].order > head.last_order - endpoints_[b].order;
  });
  std::vector<uint32_t> newest(topic_bucket_count, nothing);
  for (const uint32_t slot : linked) {
    EndpointEntry & entry = endpoints_[slot];
    uint32_t & behind = newest[entry.topic_hash % topic_bucket_count];
    entry.next_of_topic.store(behind, std::memory_order_release);
    entry.previous_of_topic = nothing;
    if (behind != nothing) {
      endpoints_[behind].previous_of_topic = slot;
    }
    behind = slot;
  }
  for (uint32_t i = 0; i < topic_bucket_count; ++i) {
    head.topic_buckets[i].first.store(newest[i], std::memory_order_release);
  }
}

}  // namespace manycore
