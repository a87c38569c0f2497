// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/landings.hpp"

#include "transport/transfer/landing.hpp"
#include "transport/transfer/sessions.hpp"

namespace manycore::landings {
namespace {

/// Nothing that was published before is on its way there.
void begin(LandingHeader & landing, uint64_t last) noexcept {
  for (std::atomic<uint64_t> * word :
       {&landing.arrived, &landing.done, &landing.handed, &landing.closed}) {
    word->store(last, std::memory_order_seq_cst);
  }
}

void name_publisher(LandingHeader & landing, const TopicDsmHeader & dsm) noexcept {
  landing.endpoint.store(dsm.endpoint.load());
  landing.incarnation.store(dsm.incarnation.load());
  landing.magic.store(landing_magic, std::memory_order_release);
}

LandingHeader * retired_landing(
  const LandingTable & table, const TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  const uint64_t offset = table.retired[receiver.id() - 1].load();
  return offset != 0 ? receiver.find<LandingHeader>(offset, landing_bytes(dsm)) : nullptr;
}

NeededBlock block_of_landing(const TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  const uint64_t bytes = landing_bytes(dsm);
  const uint64_t data_bytes = dsm.generations[0].data_bytes.load(std::memory_order_relaxed);
  return {receiver.id(), bytes, bytes - data_bytes, true};
}

void retire(LandingTable & table, uint32_t receiver) noexcept {
  if (table.landings[receiver - 1].load() != 0) {
    table.retired[receiver - 1].store(table.landings[receiver - 1].load());
    // Dekker with publisher and movers: each stores its phase before it looks for the landing.
    table.landings[receiver - 1].store(0, std::memory_order_seq_cst);
  }
}

}  // namespace

std::optional<NeededBlock> find_place(
  Registry & registry, const EndpointEntry & publisher, TopicDsmHeader & dsm,
  const Cluster & receiver, const BlockInHand * hand) {
  const LandingTable * const table = landing_table(registry.clusters().at(publisher.cluster), dsm);
  if (
    table == nullptr || receiver.id() == publisher.cluster ||
    table->landings[receiver.id() - 1].load() != 0) {
    return std::nullopt;
  }
  if (publisher.transfer == Transfer::session) {
    require_free_session(registry, publisher, receiver.id());
  }
  const NeededBlock needed = block_of_landing(dsm, receiver);
  const bool is_there =
    retired_landing(*table, dsm, receiver) != nullptr || (hand != nullptr && hand->has(needed));
  return is_there ? std::nullopt : std::optional(needed);
}

void attach(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver, BlockInHand * hand) {
  LandingTable * const table = landing_table(cluster, dsm);
  if (
    table == nullptr || receiver.id() == cluster.id() ||
    table->landings[receiver.id() - 1].load() != 0) {
    return;
  }
  LandingHeader * landing = retired_landing(*table, dsm, receiver);
  const bool is_new = landing == nullptr && hand != nullptr;
  if (is_new) {
    landing = receiver.find<LandingHeader>(hand->take().offset(), landing_bytes(dsm));
  }
  if (landing == nullptr) {
    return;  // damaged
  }
  if (is_new) {
    name_publisher(*landing, dsm);
  }
  begin(*landing, dsm.last.load(std::memory_order_seq_cst));
  table->landings[receiver.id() - 1].store(
    receiver.ref_of(landing).offset(), std::memory_order_seq_cst);
  table->retired[receiver.id() - 1].store(0);
}

void count_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters) {
    table->readers[receiver - 1].fetch_add(1);
  }
}

void discount_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters && table->readers[receiver - 1].load() != 0) {
    table->readers[receiver - 1].fetch_sub(1);
  }
}

void forget_readers(const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t i = 0; table != nullptr && i < max_clusters; ++i) {
    table->readers[i].store(0);
  }
}

void retire_unread(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters && table->readers[receiver - 1].load() == 0) {
    retire(*table, receiver);
  }
}

bool has_retired(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  const LandingTable * const table = landing_table(cluster, dsm);
  return table != nullptr && table->retired[receiver - 1].load() != 0 &&
         table->landings[receiver - 1].load() == 0;
}

void take_up_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept {
  if (LandingTable * const table = landing_table(cluster, dsm)) {
    std::atomic<uint64_t> & retired = table->retired[receiver.id() - 1];
    hand.take_up(SegmentRef::make(receiver.id(), retired.load()), landing_bytes(dsm));
    retired.store(0);
  }
}

const Cluster * retire_next(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    if (table->landings[id - 1].load() == 0 && table->retired[id - 1].load() == 0) {
      continue;
    }
    if (const Cluster * const receiver = registry.map_cluster(id)) {
      retire(*table, id);
      return receiver;
    }
  }
  return nullptr;
}

void mark_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
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

void close_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const Cluster * const receiver =
      table->landings[id - 1].load() == 0 ? nullptr : clusters.find(id);
    const Landing landing = receiver == nullptr ? Landing() : Landing::of(cluster, dsm, *receiver);
    if (landing) {
      landing.header().closed.store(dsm.last.load(), std::memory_order_seq_cst);
    }
  }
}

}  // namespace manycore::landings
