// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

namespace manycore {

/// The values of each ROS 2 policy that an endpoint can have.
enum class Reliability : uint8_t { best_effort, reliable };
enum class Durability : uint8_t { is_volatile, transient_local };
enum class History : uint8_t { keep_last, keep_all };
enum class Liveliness : uint8_t { automatic, manual_by_topic };

/// Value of a duration policy without a limit.
constexpr int64_t infinite_ns = INT64_MAX;

/// QoS of one endpoint as stored in the registry. Durations are in nanoseconds.
struct Qos {
  int64_t deadline_ns = infinite_ns;
  int64_t lifespan_ns = infinite_ns;
  int64_t liveliness_lease_ns = infinite_ns;
  uint32_t depth = 10;  ///< of KEEP_LAST; at least 1
  Reliability reliability = Reliability::reliable;
  Durability durability = Durability::is_volatile;
  History history = History::keep_last;
  Liveliness liveliness = Liveliness::automatic;
};
static_assert(sizeof(Qos) == 32 && std::is_trivially_copyable_v<Qos>);

/// Policies by which an offer can be incompatible with a request, in the order of their DDS
/// numbers.
enum class QosPolicy : uint8_t { none, durability, deadline, liveliness, reliability };

}  // namespace manycore
