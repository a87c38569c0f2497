// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/endpoint_terms.hpp"

#include <cstring>

#include "transport/peers/qos_compatibility.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

EndpointTerms::EndpointTerms(const EndpointEntry & entry)
: kind(entry.kind),
  role(entry.role),
  ignore_local(entry.ignore_local != 0),
  process(entry.process.load(std::memory_order_relaxed)),
  topic_hash(entry.topic_hash),
  topic(text_of(entry.topic)),
  type(text_of(entry.type)),
  qos(entry.qos) {}

Fit fit_of(const EndpointTerms & own, const EndpointEntry & other) {
  const bool is_publisher = own.kind == EndpointKind::publisher;
  const bool ignores_local = is_publisher ? other.ignore_local != 0 : own.ignore_local;
  if (
    other.kind == own.kind || other.topic_hash != own.topic_hash || other.role != own.role ||
    std::strncmp(other.topic, own.topic.c_str(), name_bytes) != 0 ||
    (ignores_local && other.process.load(std::memory_order_relaxed) == own.process)) {
    return {Fit::Kind::strangers};
  }
  if (std::strncmp(other.type, own.type.c_str(), name_bytes) != 0) {
    return {Fit::Kind::other_type};
  }
  const QosPolicy policy = is_publisher ? last_incompatible_policy(own.qos, other.qos)
                                        : last_incompatible_policy(other.qos, own.qos);
  return policy == QosPolicy::none ? Fit{Fit::Kind::matched} : Fit{Fit::Kind::other_qos, policy};
}

}  // namespace manycore
