// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/transfer.hpp"

#include "transport/transfer/sessions.hpp"

namespace manycore::transfer {
namespace {

void retire(LandingTable & table, uint32_t receiver) noexcept {
  if (table.landings[receiver - 1].load() != 0) {
    table.retired[receiver - 1].store(table.landings[receiver - 1].load());
    // Dekker with publisher and movers: each stores its phase before it looks for the landing.
    table.landings[receiver - 1].store(0, std::memory_order_seq_cst);
  }
}

bool has_landing(const LandingTable & table, uint32_t receiver) noexcept {
  return table.landings[receiver - 1].load() != 0 || table.retired[receiver - 1].load() != 0;
}

void take_up(
  LandingTable & table, const TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept {
  std::atomic<uint64_t> & retired = table.retired[receiver.id() - 1];
  hand.take_up(SegmentRef::make(receiver.id(), retired.load()), landing_bytes(dsm));
  retired.store(0);
}

}  // namespace

void retire(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters) {
    retire(*table, receiver);
  }
}

bool has_room(const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  return static_cast<bool>(Landing::of(cluster, dsm, receiver));
}

bool take_up_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  const bool is_retired = table != nullptr && table->retired[receiver.id() - 1].load() != 0 &&
                          table->landings[receiver.id() - 1].load() == 0;
  if (is_retired && dsm.phase.load(std::memory_order_seq_cst) % 2 != 0) {
    return false;
  }
  if (is_retired) {
    take_up(*table, dsm, receiver, hand);
  }
  return true;
}

bool take_up_all(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, BlockInHand & hand) {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const Cluster * const receiver = has_landing(*table, id) ? registry.map_cluster(id) : nullptr;
    if (receiver != nullptr) {
      retire(*table, id);
      take_up(*table, dsm, *receiver, hand);
      if (!hand.is_empty()) {
        return false;
      }
    }
  }
  return true;
}

void mark(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const uint64_t used = table->landings[id - 1].load();
    const uint64_t offset = used != 0 ? used : table->retired[id - 1].load();
    Cluster * const receiver = offset == 0 ? nullptr : clusters.find(id);
    if (receiver != nullptr) {
      receiver->mark_allocated(offset, landing_bytes(dsm));
    }
  }
}

void end(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const Cluster * const receiver =
      table->landings[id - 1].load() == 0 ? nullptr : clusters.find(id);
    const Landing landing = receiver == nullptr ? Landing() : Landing::of(cluster, dsm, *receiver);
    if (landing) {
      landing.header().decided.store(dsm.last.load(), std::memory_order_seq_cst);
    }
  }
}

}  // namespace manycore::transfer
