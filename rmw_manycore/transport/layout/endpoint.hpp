// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "transport/layout/qos.hpp"

namespace manycore {

/// Globally unique identifier of an endpoint: platform nonce, endpoint slot, incarnation. A
/// publisher that stands for one of another host has that one's.
using Gid = std::array<uint8_t, 16>;

/// Slot and incarnation in a gid of this platform, packed as by trace_endpoint().
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

/// Parameters of a new publisher or subscription.
struct EndpointSpec {
  uint32_t node = 0;  ///< node handle from Process::add_node()
  EndpointRole role = EndpointRole::topic;
  std::string topic;  ///< fully qualified ROS name; for services the service's name
  std::string type;   ///< "std_msgs/msg/String"; for services the service's type
  TypeHash type_hash;
  Qos qos;
  bool ignore_local = false;  ///< subscription only: do not match publishers of the same process
  std::optional<Gid> gid;     ///< publisher only: that of another host which it stands for
};

/// Client and request number of a request or reply; all zero on topics.
struct Correlation {
  Gid client{};  ///< gid of the client's reply subscription
  int64_t number = 0;
};

/// Counts reported by the matched event of an endpoint.
struct MatchedCount {
  uint64_t total = 0;    ///< matches so far
  uint64_t current = 0;  ///< matches now
};

/// A count that rises as time passes (deadlines missed, leases lost).
struct TimedCount {
  uint64_t total = 0;
  int64_t next_due_ns = infinite_ns;  ///< CLOCK_MONOTONIC: when `total` rises next unless a message
                                      ///< or an assertion comes first
};

/// Matched publishers of a subscription, by liveliness.
struct LivelinessCount {
  uint64_t alive = 0;
  uint64_t not_alive = 0;
  /// CLOCK_MONOTONIC: when the next lease runs out unless it is renewed.
  int64_t next_due_ns = infinite_ns;
};

/// Counts reported by the incompatible-QoS event of an endpoint.
struct IncompatibleCount {
  uint64_t total = 0;
  QosPolicy last_policy = QosPolicy::none;
};

}  // namespace manycore
