// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/subscription_block.hpp"

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

}  // namespace

SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot) {
  EndpointEntry & entry = registry.endpoints()[endpoint_slot];
  Cluster & cluster = registry.clusters().at(entry.cluster);
  const bool keeps_all = entry.qos.history == History::keep_all;
  const uint32_t depth = keeps_all ? keep_all_capacity : entry.qos.depth;
  const uint32_t log2 = log2_at_least(depth);
  auto & header = cluster.allocate_cleared<SubscriptionHeader>(
    sizeof(SubscriptionHeader) + (uint64_t{8} << log2));
  header.endpoint.store(endpoint_slot);
  header.incarnation.store(entry.slot.incarnation);
  header.process.store(entry.process);
  header.depth = depth;
  header.slot_count_log2 = log2;
  header.keep_all = keeps_all ? 1 : 0;
  header.has_deadline = entry.qos.deadline_ns == infinite_ns ? 0 : 1;
  header.deadline_ns = entry.qos.deadline_ns;
  header.deadline.reset();
  header.watchers.add(common_word);
  subscriber_queue::initialize(header);
  header.magic.store(subscription_magic, std::memory_order_release);
  return header;
}

}  // namespace manycore::subscription_block
