// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/subscription_block.hpp"

#include "platform/error.hpp"
#include "transport/queue/subscriber_queue.hpp"

namespace manycore::subscription_block {
namespace {

uint32_t log2_at_least(uint32_t x) {
  uint32_t log2 = 0;
  while ((uint64_t{1} << log2) < x) {
    ++log2;
  }
  return log2;
}

uint32_t depth_of(const Qos & qos) noexcept {
  return qos.history == History::keep_all ? keep_all_capacity : qos.depth;
}

SubscriptionHeader & cleared_block(Cluster & cluster, uint64_t bytes, BlockInHand * hand) {
  if (hand == nullptr) {
    return cluster.allocate_cleared<SubscriptionHeader>(bytes);
  }
  auto * const made = cluster.find<SubscriptionHeader>(hand->block().offset(), bytes);
  if (made == nullptr) {
    throw Error(
      ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  return *made;
}

}  // namespace

uint64_t bytes_for(const Qos & qos) noexcept {
  return subscription_block_bytes(log2_at_least(depth_of(qos)));
}

NeededBlock block_for(const Qos & qos, uint32_t cluster) noexcept {
  const uint64_t bytes = bytes_for(qos);
  return {cluster, bytes, bytes, false};
}

SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot, BlockInHand * hand) {
  EndpointEntry & entry = registry.endpoints()[endpoint_slot];
  Cluster & cluster = registry.clusters().at(entry.cluster);
  const uint32_t depth = depth_of(entry.qos);
  const uint32_t log2 = log2_at_least(depth);
  SubscriptionHeader & header = cleared_block(cluster, bytes_for(entry.qos), hand);
  header.endpoint.store(endpoint_slot);
  header.incarnation.store(entry.slot.incarnation);
  header.process.store(entry.process);
  header.depth = depth;
  header.slot_count_log2 = log2;
  header.keep_all = entry.qos.history == History::keep_all ? 1 : 0;
  header.has_deadline = entry.qos.deadline_ns == infinite_ns ? 0 : 1;
  header.deadline_ns = entry.qos.deadline_ns;
  header.deadline.reset();
  header.watchers.add(common_word);
  subscriber_queue::initialize(header);
  header.magic.store(subscription_magic, std::memory_order_release);
  return header;
}

}  // namespace manycore::subscription_block
