// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/new_endpoint.hpp"

#include <algorithm>
#include <cstring>

#include "transport/qos/manual_liveliness.hpp"
#include "transport/subscription/subscription_block.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {
namespace {

Gid make_gid(const Registry & registry, uint32_t slot, uint32_t incarnation) {
  const uint64_t nonce = registry.nonce();
  Gid gid{};
  std::memcpy(gid.data(), &nonce, 8);
  std::memcpy(gid.data() + 8, &slot, 4);
  std::memcpy(gid.data() + 12, &incarnation, 4);
  return gid;
}

}  // namespace

uint32_t new_endpoint(
  Registry & registry, const EndpointSpec & spec, EndpointKind kind, uint32_t process) {
  const uint32_t taken = registry.endpoints().take("endpoints");
  EndpointEntry & entry = registry.endpoints()[taken];
  try {
    store_name(entry.topic, spec.topic, "topic");
    store_name(entry.type, spec.type, "type");
  } catch (...) {
    registry.endpoints().give_back(taken);
    throw;
  }
  entry.kind = kind;
  entry.role = spec.role;
  entry.ignore_local = spec.ignore_local ? 1 : 0;
  entry.process = process;
  entry.node = spec.node;
  entry.cluster = registry.processes()[process].cluster;
  entry.topic_hash = hash_name(entry.topic);
  entry.block = SegmentRef{};
  entry.gid = spec.gid.value_or(make_gid(registry, taken, entry.slot.incarnation));
  entry.qos = spec.qos;
  entry.type_hash_version = spec.type_hash.version;
  std::copy(spec.type_hash.value.begin(), spec.type_hash.value.end(), entry.type_hash);
  for (std::atomic<uint64_t> * count :
       {&entry.counters.messages, &entry.counters.bytes, &entry.counters.lost,
        &entry.counters.superseded, &entry.counters.expired, &entry.counters.refused,
        &entry.counters.overwritten, &entry.counters.dropped, &entry.counters.in_place}) {
    count->store(0);
  }
  entry.asserted_ns.store(ManualLiveliness::never);
  entry.died.store(0);
  return taken;
}

uint32_t enter_graph(
  Registry & registry, const Membership & membership, const EndpointSpec & spec, EndpointKind kind,
  uint32_t process, BlockInHand * hand) {
  const TopicEntry * const configured = registry.find_topic(spec.topic);  // entries never change
  const Registry::Lock lock(registry);
  membership.require();
  const uint32_t taken = new_endpoint(registry, spec, kind, process);
  EndpointEntry & entry = registry.endpoints()[taken];
  entry.topic_dsm_size = configured == nullptr ? 0 : configured->topic_dsm_size;
  entry.transfer = transfer::kind_of(configured, spec, kind);
  entry.zero_copy = configured == nullptr ? ZeroCopy::unset : configured->zero_copy;
  try {
    const void * const block =
      kind == EndpointKind::publisher
        ? static_cast<void *>(&TopicDsmWriter::create(registry, taken))
        : static_cast<void *>(&subscription_block::create(registry, taken, hand));
    entry.block = registry.clusters().at(entry.cluster).ref_of(block);
  } catch (...) {
    registry.endpoints().give_back(taken);
    throw;
  }
  entry.order = ++registry.header().last_order;
  registry.endpoints().publish(taken);
  if (hand != nullptr) {
    hand->let_go();
  }
  registry.link_endpoint(taken);
  registry.raise_changes(entry.topic_hash);
  return taken;
}

}  // namespace manycore
