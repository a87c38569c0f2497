// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/qos/qos.hpp"

#include <limits>
#include <string>

#include "platform/error.hpp"
#include "rmw/qos_profiles.h"
#include "rmw/time.h"

namespace rmw_manycore {
namespace {

using manycore::EndpointKind;

[[noreturn]] void refuse_unknown(const char * policy) {
  throw manycore::Error(
    manycore::ErrorCode::invalid_argument,
    std::string("the QoS profile has an unknown ") + policy + " policy");
}

/// Unspecified, infinite and overflowing durations all mean no limit.
int64_t to_ns(const rmw_time_t & duration) {
  const int64_t ns = rmw_time_total_nsec(duration);
  return ns == 0 ? manycore::infinite_ns : ns;
}

rmw_time_t to_duration(int64_t ns) { return rmw_time_from_nsec(ns); }

manycore::History history_of(const rmw_qos_profile_t & profile) {
  switch (profile.history) {
    case RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT:
    case RMW_QOS_POLICY_HISTORY_KEEP_LAST:
      return manycore::History::keep_last;
    case RMW_QOS_POLICY_HISTORY_KEEP_ALL:
      return manycore::History::keep_all;
    default:
      refuse_unknown("history");
  }
}

manycore::Reliability reliability_of(const rmw_qos_profile_t & profile, EndpointKind kind) {
  switch (profile.reliability) {
    case RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT:
      return kind == EndpointKind::publisher ? manycore::Reliability::reliable
                                             : manycore::Reliability::best_effort;
    case RMW_QOS_POLICY_RELIABILITY_RELIABLE:
      return manycore::Reliability::reliable;
    case RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT:
      return manycore::Reliability::best_effort;
    default:
      refuse_unknown("reliability");
  }
}

manycore::Durability durability_of(const rmw_qos_profile_t & profile, EndpointKind kind) {
  switch (profile.durability) {
    case RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT:
      return kind == EndpointKind::publisher ? manycore::Durability::transient_local
                                             : manycore::Durability::is_volatile;
    case RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL:
      return manycore::Durability::transient_local;
    case RMW_QOS_POLICY_DURABILITY_VOLATILE:
      return manycore::Durability::is_volatile;
    default:
      refuse_unknown("durability");
  }
}

manycore::Liveliness liveliness_of(const rmw_qos_profile_t & profile) {
  switch (profile.liveliness) {
    case RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT:
    case RMW_QOS_POLICY_LIVELINESS_AUTOMATIC:
      return manycore::Liveliness::automatic;
    case RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC:
      return manycore::Liveliness::manual_by_topic;
    default:
      refuse_unknown("liveliness");
  }
}

uint32_t depth_of(const rmw_qos_profile_t & profile) {
  if (profile.depth > static_cast<size_t>(std::numeric_limits<int32_t>::max())) {
    throw manycore::Error(
      manycore::ErrorCode::invalid_argument,
      "the QoS history depth " + std::to_string(profile.depth) + " is more than 2147483647");
  }
  return profile.depth == RMW_QOS_POLICY_DEPTH_SYSTEM_DEFAULT
           ? 1
           : static_cast<uint32_t>(profile.depth);
}

}  // namespace

manycore::Qos to_transport(const rmw_qos_profile_t & profile, EndpointKind kind) {
  manycore::Qos qos;
  qos.history = history_of(profile);
  qos.depth = depth_of(profile);
  qos.reliability = reliability_of(profile, kind);
  qos.durability = durability_of(profile, kind);
  qos.deadline_ns = to_ns(profile.deadline);
  qos.lifespan_ns = to_ns(profile.lifespan);
  qos.liveliness = liveliness_of(profile);
  qos.liveliness_lease_ns = to_ns(profile.liveliness_lease_duration);
  return qos;
}

rmw_qos_profile_t to_rmw(const manycore::Qos & qos) {
  rmw_qos_profile_t profile = rmw_qos_profile_unknown;
  profile.history = qos.history == manycore::History::keep_all ? RMW_QOS_POLICY_HISTORY_KEEP_ALL
                                                               : RMW_QOS_POLICY_HISTORY_KEEP_LAST;
  profile.depth = qos.depth;
  profile.reliability = qos.reliability == manycore::Reliability::reliable
                          ? RMW_QOS_POLICY_RELIABILITY_RELIABLE
                          : RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  profile.durability = qos.durability == manycore::Durability::transient_local
                         ? RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL
                         : RMW_QOS_POLICY_DURABILITY_VOLATILE;
  profile.deadline = to_duration(qos.deadline_ns);
  profile.lifespan = to_duration(qos.lifespan_ns);
  profile.liveliness = qos.liveliness == manycore::Liveliness::manual_by_topic
                         ? RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC
                         : RMW_QOS_POLICY_LIVELINESS_AUTOMATIC;
  profile.liveliness_lease_duration = to_duration(qos.liveliness_lease_ns);
  return profile;
}

}  // namespace rmw_manycore
