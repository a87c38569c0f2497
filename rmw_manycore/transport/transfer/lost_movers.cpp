// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of transfer.hpp: sessions whose mover will not go on.
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::transfer {
namespace {

bool has_movers(Registry & registry, uint32_t cluster) {
  const Lifelines & lifelines = registry.lifelines();
  if (lifelines.is_locked(receive_thread_line + cluster)) {
    return true;
  }
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (
      registry.processes().is_live(slot) && registry.processes()[slot].cluster == cluster &&
      lifelines.is_locked(slot)) {
      return true;  // it starts another receive thread
    }
  }
  return false;
}

/// True if a record that the owner of the seat has not taken is in the landing, announced or not.
/// The topic DSM has one generation.
bool has_arrived(
  const Cluster & cluster, const TopicDsmHeader & dsm, const Landing & landing, const Seat & seat) {
  const GenerationEntry & only = dsm.generations[0];
  const uint32_t count = only.descriptor_count.load();
  const auto * const descriptors =
    cluster.find<RecordDescriptor>(only.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
  const uint64_t taken = seat.taken.load(std::memory_order_acquire);
  for (uint32_t i = 0; descriptors != nullptr && i < count; ++i) {
    const uint64_t number = descriptors[i].number.load(std::memory_order_acquire);
    if (number > taken && number <= landing.arrived() && landing.has(number)) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// No thread moves the records of a cluster's sessions once the last process of that cluster has
/// gone.
bool can_arrive(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm,
  SubscriptionHeader & subscription, uint32_t receiver, const Seat & seat) {
  const Cluster * const to = static_cast<Transfer>(dsm.transfer) == Transfer::session
                               ? registry.map_cluster(receiver)
                               : nullptr;
  const Landing landing = to == nullptr ? Landing() : Landing::of(cluster, dsm, *to);
  if (!landing || has_movers(registry, cluster.id())) {
    return true;
  }
  if (!has_arrived(cluster, dsm, landing, seat)) {
    return false;
  }
  subscription.resync.store(1, std::memory_order_seq_cst);
  notify_watchers(registry, subscription);
  return true;
}

}  // namespace manycore::transfer
