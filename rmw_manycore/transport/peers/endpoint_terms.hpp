// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "transport/layout/registry_layout.hpp"

namespace manycore {

/// What decides with which others an endpoint is matched. A copy: an endpoint's row may be given to
/// another one.
struct EndpointTerms {
  EndpointKind kind;
  EndpointRole role;
  bool ignore_local;
  uint32_t process;
  uint64_t topic_hash;
  std::string topic;
  std::string type;
  Qos qos;

  explicit EndpointTerms(const EndpointEntry & entry);
};

/// How two endpoints go together.
struct Fit {
  enum class Kind : uint8_t {
    strangers,   ///< no event on either side
    other_type,  ///< counted as of incompatible type
    other_qos,   ///< counted as of incompatible QoS
    matched,
  };
  Kind kind;
  QosPolicy policy = QosPolicy::none;  ///< of `other_qos`
};

/// `other` may be a copy of a row.
Fit fit_of(const EndpointTerms & own, const EndpointEntry & other);

}  // namespace manycore
