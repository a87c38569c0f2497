// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "transport/layout/qos.hpp"

namespace manycore {

/// Globally unique name of an endpoint: platform nonce, endpoint slot, incarnation (see gid.hpp).
using Gid = std::array<uint8_t, 16>;

/// Slot and incarnation of the endpoint, as trace_endpoint() puts them.
inline uint64_t endpoint_in(const Gid & gid) noexcept {
  uint64_t word = 0;
  std::memcpy(&word, gid.data() + 8, sizeof word);
  return word;
}

enum class EndpointKind : uint8_t { publisher, subscription };

/// What an endpoint carries. A service server is a `request` subscription with a `reply` publisher;
/// a client is a `request` publisher with a `reply` subscription.
enum class EndpointRole : uint8_t { topic, request, reply };

/// REP 2011 type hash (RIHS).
struct TypeHash {
  uint8_t version = 0;
  std::array<uint8_t, 32> value{};
};

/// What a node asks for when it creates a publisher or a subscription.
struct EndpointSpec {
  uint32_t node = 0;  ///< handle from Process::add_node
  EndpointRole role = EndpointRole::topic;
  std::string topic;  ///< fully qualified ROS name; for services the service's name
  std::string type;   ///< "std_msgs/msg/String"; for services the service's type
  TypeHash type_hash;
  Qos qos;
  bool ignore_local =
    false;  ///< subscription only: not matched with publishers of the same process
};

/// Client and request number that a request or reply belongs to; all zero on topics.
struct Correlation {
  Gid client{};  ///< gid of the client's reply subscription
  int64_t number = 0;
};

/// Counts behind the matched event of one endpoint.
struct MatchedCount {
  uint64_t total = 0;    ///< matches so far
  uint64_t current = 0;  ///< matches now
};

/// A count that rises with time (deadlines missed, leases lost), and when it will next unless
/// something happens.
struct TimedCount {
  uint64_t total = 0;
  int64_t next_due_ns = infinite_ns;  ///< CLOCK_MONOTONIC
};

/// A subscription's publishers, by liveliness.
struct LivelinessCount {
  uint64_t alive = 0;
  uint64_t not_alive = 0;
  int64_t next_due_ns = infinite_ns;  ///< CLOCK_MONOTONIC: the next lease runs out, unless asserted
};

/// Counts behind the incompatible-QoS event of one endpoint.
struct IncompatibleCount {
  uint64_t total = 0;
  QosPolicy last_policy = QosPolicy::none;
};

}  // namespace manycore
