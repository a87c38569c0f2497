// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/qos_best_available.hpp"

#include <algorithm>

#include "rmw/graph/topic_endpoints.hpp"
#include "rmw/time.h"

namespace rmw_manycore {
namespace {

using manycore::EndpointInfo;

constexpr rmw_time_t best_available_deadline = RMW_QOS_DEADLINE_BEST_AVAILABLE;
constexpr rmw_time_t best_available_lease = RMW_QOS_LIVELINESS_LEASE_DURATION_BEST_AVAILABLE;

void resolve(rmw_time_t & duration, const rmw_time_t & best_available, int64_t ns) {
  if (rmw_time_equal(duration, best_available)) {
    duration = rmw_time_from_nsec(ns);
  }
}

template<typename Policy>
void resolve(Policy & policy, Policy best_available, Policy value) {
  if (policy == best_available) {
    policy = value;
  }
}

bool is_manual(const EndpointInfo & endpoint) {
  return endpoint.qos.liveliness == manycore::Liveliness::manual_by_topic;
}

bool has_best_available(const rmw_qos_profile_t & profile) {
  return profile.reliability == RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE ||
         profile.durability == RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE ||
         profile.liveliness == RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE ||
         rmw_time_equal(profile.deadline, best_available_deadline) ||
         rmw_time_equal(profile.liveliness_lease_duration, best_available_lease);
}

rmw_qos_profile_t resolve_for_subscription(
  rmw_qos_profile_t profile, const std::vector<EndpointInfo> & others) {
  const auto all = [&](auto && has) { return std::all_of(others.begin(), others.end(), has); };
  // The longest duration of the publishers; no limit if one of them has none, or without
  // publishers.
  const auto longest = [&](int64_t manycore::Qos::*duration) {
    int64_t ns = others.empty() ? manycore::infinite_ns : 0;
    for (const EndpointInfo & other : others) {
      ns = std::max(ns, other.qos.*duration);
    }
    return ns;
  };
  const bool reliable = all(
    [](const EndpointInfo & p) { return p.qos.reliability == manycore::Reliability::reliable; });
  const bool transient_local = all([](const EndpointInfo & p) {
    return p.qos.durability == manycore::Durability::transient_local;
  });
  resolve(
    profile.reliability, RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE,
    reliable ? RMW_QOS_POLICY_RELIABILITY_RELIABLE : RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT);
  resolve(
    profile.durability, RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE,
    transient_local ? RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL
                    : RMW_QOS_POLICY_DURABILITY_VOLATILE);
  resolve(
    profile.liveliness, RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE,
    all(is_manual) ? RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC
                   : RMW_QOS_POLICY_LIVELINESS_AUTOMATIC);
  resolve(profile.deadline, best_available_deadline, longest(&manycore::Qos::deadline_ns));
  resolve(
    profile.liveliness_lease_duration, best_available_lease,
    longest(&manycore::Qos::liveliness_lease_ns));
  return profile;
}

rmw_qos_profile_t resolve_for_publisher(
  rmw_qos_profile_t profile, const std::vector<EndpointInfo> & others) {
  const auto shortest = [&](int64_t manycore::Qos::*duration) {
    int64_t ns = manycore::infinite_ns;
    for (const EndpointInfo & other : others) {
      ns = std::min(ns, other.qos.*duration);
    }
    return ns;
  };
  resolve(
    profile.reliability, RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE,
    RMW_QOS_POLICY_RELIABILITY_RELIABLE);
  resolve(
    profile.durability, RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE,
    RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL);
  resolve(
    profile.liveliness, RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE,
    std::any_of(others.begin(), others.end(), is_manual) ? RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC
                                                         : RMW_QOS_POLICY_LIVELINESS_AUTOMATIC);
  resolve(profile.deadline, best_available_deadline, shortest(&manycore::Qos::deadline_ns));
  resolve(
    profile.liveliness_lease_duration, best_available_lease,
    shortest(&manycore::Qos::liveliness_lease_ns));
  return profile;
}

}  // namespace

rmw_qos_profile_t best_available_for_subscription(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile) {
  return has_best_available(profile) ? resolve_for_subscription(profile, publishers_of(node, topic))
                                     : profile;
}

rmw_qos_profile_t best_available_for_publisher(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile) {
  return has_best_available(profile) ? resolve_for_publisher(profile, subscriptions_of(node, topic))
                                     : profile;
}

rmw_qos_profile_t best_available_for_service(rmw_qos_profile_t profile) {
  resolve(
    profile.reliability, RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE,
    RMW_QOS_POLICY_RELIABILITY_RELIABLE);
  resolve(
    profile.durability, RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE,
    RMW_QOS_POLICY_DURABILITY_VOLATILE);
  resolve(
    profile.liveliness, RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE,
    RMW_QOS_POLICY_LIVELINESS_AUTOMATIC);
  resolve(profile.deadline, best_available_deadline, manycore::infinite_ns);
  resolve(profile.liveliness_lease_duration, best_available_lease, manycore::infinite_ns);
  return profile;
}

}  // namespace rmw_manycore
