// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/landings.hpp"

#include <cstring>

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

LandingHeader & make(TopicDsmHeader & dsm, Cluster & receiver) {
  const uint64_t bytes = landing_bytes(dsm);
  receiver.require_message_room(bytes);
  receiver.require_file_system_room(bytes);
  const uint64_t offset = receiver.allocate(bytes);
  auto & landing = *receiver.find<LandingHeader>(offset);
  const uint32_t marks = dsm.generations[0].descriptor_count.load();
  std::memset(
    static_cast<void *>(&landing), 0, sizeof landing + uint64_t{marks} * sizeof(uint64_t));
  landing.endpoint.store(dsm.endpoint.load());
  landing.incarnation.store(dsm.incarnation.load());
  landing.magic.store(landing_magic, std::memory_order_release);
  return landing;
}

}  // namespace

void ensure(
  Registry & registry, const EndpointEntry & publisher, TopicDsmHeader & dsm, Cluster & receiver) {
  LandingTable * const table = landing_table(registry.clusters().at(publisher.cluster), dsm);
  if (table == nullptr || receiver.id() == publisher.cluster) {
    return;
  }
  std::atomic<uint64_t> & used = table->landings[receiver.id() - 1];
  std::atomic<uint64_t> & retired = table->retired[receiver.id() - 1];
  if (used.load() != 0) {
    return;
  }
  if (publisher.transfer == Transfer::session) {
    require_free_session(registry, publisher, receiver.id());
  }
  auto * landing = receiver.find<LandingHeader>(retired.load(), landing_bytes(dsm));
  const bool is_new = retired.load() == 0 || landing == nullptr;
  if (is_new) {
    landing = &make(dsm, receiver);
  }
  begin(*landing, dsm.last.load(std::memory_order_seq_cst));
  used.store(receiver.ref_of(landing).offset(), std::memory_order_seq_cst);
  retired.store(0);
}

void retire(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  const bool is_cluster = receiver != 0 && receiver <= max_clusters;
  if (table != nullptr && is_cluster && table->landings[receiver - 1].load() != 0) {
    table->retired[receiver - 1].store(table->landings[receiver - 1].load());
    // Dekker with publisher and movers: each stores its phase before it looks for the landing.
    table->landings[receiver - 1].store(0, std::memory_order_seq_cst);
  }
}

bool has_retired(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  const LandingTable * const table = landing_table(cluster, dsm);
  return table != nullptr && table->retired[receiver - 1].load() != 0 &&
         table->landings[receiver - 1].load() == 0;
}

void free_retired(const Cluster & cluster, TopicDsmHeader & dsm, Cluster & receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  const uint64_t offset = table == nullptr ? 0 : table->retired[receiver.id() - 1].exchange(0);
  if (offset != 0) {
    receiver.free(offset, landing_bytes(dsm));
  }
}

/// Out of the table before it is free: should this process die in between, the next owner of the
/// lock builds the map without it.
bool free_one(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    std::atomic<uint64_t> & used = table->landings[id - 1];
    if (used.load() == 0 && table->retired[id - 1].load() == 0) {
      continue;
    }
    Cluster * const receiver = registry.map_cluster(id);
    if (receiver == nullptr) {
      continue;
    }
    retire(cluster, dsm, id);
    free_retired(cluster, dsm, *receiver);
    return true;
  }
  return false;
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
