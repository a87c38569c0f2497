// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/graph_matches.hpp"

#include <unordered_map>

#include "transport/peers/qos_compatibility.hpp"

namespace manycore {
namespace {

bool is_match(const EndpointInfo & publisher, const EndpointInfo & subscription) {
  return publisher.role == subscription.role && publisher.type == subscription.type &&
         !(subscription.ignore_local && subscription.process == publisher.process) &&
         last_incompatible_policy(publisher.qos, subscription.qos) == QosPolicy::none;
}

}  // namespace

std::vector<uint64_t> count_matches(const std::vector<EndpointInfo> & endpoints) {
  std::unordered_map<std::string, std::vector<size_t>> publishers;  // by topic
  for (size_t i = 0; i < endpoints.size(); ++i) {
    if (endpoints[i].kind == EndpointKind::publisher) {
      publishers[endpoints[i].topic].push_back(i);
    }
  }
  std::vector<uint64_t> counts(endpoints.size(), 0);
  for (size_t i = 0; i < endpoints.size(); ++i) {
    if (endpoints[i].kind != EndpointKind::subscription) {
      continue;
    }
    for (const size_t publisher : publishers[endpoints[i].topic]) {
      if (is_match(endpoints[publisher], endpoints[i])) {
        ++counts[publisher];
        ++counts[i];
      }
    }
  }
  return counts;
}

}  // namespace manycore
