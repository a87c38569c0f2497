// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/new_endpoint.hpp"

#include <algorithm>
#include <cstring>

#include "transport/qos/manual_liveliness.hpp"

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
  Registry & registry, const EndpointSpec & spec, EndpointKind kind, uint32_t process,
  uint32_t cluster) {
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
  entry.cluster = cluster;
  entry.topic_hash = hash_name(entry.topic);
  entry.block = SegmentRef{};
  entry.gid = make_gid(registry, taken, entry.slot.incarnation);
  entry.qos = spec.qos;
  entry.type_hash_version = spec.type_hash.version;
  std::copy(spec.type_hash.value.begin(), spec.type_hash.value.end(), entry.type_hash);
  for (std::atomic<uint64_t> * count :
       {&entry.matched_total, &entry.matched_current, &entry.incompatible_total,
        &entry.incompatible_types, &entry.counters.messages, &entry.counters.bytes,
        &entry.counters.lost, &entry.counters.expired, &entry.counters.refused,
        &entry.counters.overwritten, &entry.counters.dropped}) {
    count->store(0);
  }
  entry.incompatible_policy.store(0);
  entry.asserted_ns.store(ManualLiveliness::never);
  entry.dead_publishers.store(0);
  entry.spare.ref.store(0);
  return taken;
}

}  // namespace manycore
