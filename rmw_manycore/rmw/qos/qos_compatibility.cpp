// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/qos_profiles.h"
#include "rmw/qos_string_conversions.h"
#include "rmw/time.h"

namespace rmw_manycore {
namespace {

constexpr rmw_time_t unspecified = RMW_DURATION_UNSPECIFIED;

/// True if the policy's value is only known once the endpoint exists.
template<typename Policy>
bool is_open(Policy policy, Policy system_default, Policy unknown) {
  return policy == system_default || policy == unknown;
}

/// Error text if the subscription requests more than the publisher offers, else nullptr.
const char * duration_error(
  const rmw_time_t & offered, const rmw_time_t & requested, const char * none,
  const char * longer) {
  if (rmw_time_equal(requested, unspecified)) {
    return nullptr;
  }
  if (rmw_time_equal(offered, unspecified)) {
    return none;
  }
  return rmw_time_total_nsec(requested) < rmw_time_total_nsec(offered) ? longer : nullptr;
}

/// Same wording as other middlewares: `ros2 doctor` and its tests match it.
std::string errors(const rmw_qos_profile_t & offered, const rmw_qos_profile_t & requested) {
  std::string text;
  const auto add = [&](const char * error) {
    if (error != nullptr) {
      text += std::string("ERROR: ") + error + ";";
    }
  };
  if (
    offered.reliability == RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT &&
    requested.reliability == RMW_QOS_POLICY_RELIABILITY_RELIABLE) {
    add("Best effort publisher and reliable subscription");
  }
  if (
    offered.durability == RMW_QOS_POLICY_DURABILITY_VOLATILE &&
    requested.durability == RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL) {
    add("Volatile publisher and transient local subscription");
  }
  add(duration_error(
    offered.deadline, requested.deadline, "Subscription has a deadline, but publisher does not",
    "Subscription deadline is less than publisher deadline"));
  if (
    offered.liveliness == RMW_QOS_POLICY_LIVELINESS_AUTOMATIC &&
    requested.liveliness == RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC) {
    add("Publisher's liveliness is automatic and subscription's is manual by topic");
  }
  add(duration_error(
    offered.liveliness_lease_duration, requested.liveliness_lease_duration,
    "Subscription has a liveliness lease duration, but publisher does not",
    "Subscription liveliness lease duration is less than publisher"));
  return text;
}

/// A warning if the pair may be incompatible: the offer is open or weak, the request open or
/// strong.
template<typename Policy>
std::string warning(
  const char * name, Policy offered, Policy requested, Policy weak, Policy strong,
  Policy system_default, Policy unknown, const char * (*to_string)(Policy)) {
  const bool offer_open = is_open(offered, system_default, unknown);
  const bool request_open = is_open(requested, system_default, unknown);
  const bool may_fail =
    (offer_open && (request_open || requested == strong)) || (request_open && offered == weak);
  if (!may_fail) {
    return {};
  }
  const auto text = [&](Policy policy) {
    const char * const found = to_string(policy);
    return std::string(found != nullptr ? found : "unknown");
  };
  return std::string("WARNING: Publisher ") + name + " is " + text(offered) + " and subscription " +
         name + " is " + text(requested) + ";";
}

std::string warnings(const rmw_qos_profile_t & offered, const rmw_qos_profile_t & requested) {
  return warning(
           "reliability", offered.reliability, requested.reliability,
           RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT, RMW_QOS_POLICY_RELIABILITY_RELIABLE,
           RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_RELIABILITY_UNKNOWN,
           rmw_qos_reliability_policy_to_str) +
         warning(
           "durability", offered.durability, requested.durability,
           RMW_QOS_POLICY_DURABILITY_VOLATILE, RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL,
           RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_DURABILITY_UNKNOWN,
           rmw_qos_durability_policy_to_str) +
         warning(
           "liveliness", offered.liveliness, requested.liveliness,
           RMW_QOS_POLICY_LIVELINESS_AUTOMATIC, RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC,
           RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT, RMW_QOS_POLICY_LIVELINESS_UNKNOWN,
           rmw_qos_liveliness_policy_to_str);
}

}  // namespace
}  // namespace rmw_manycore

rmw_ret_t rmw_qos_profile_check_compatible(
  const rmw_qos_profile_t publisher_profile, const rmw_qos_profile_t subscription_profile,
  rmw_qos_compatibility_type_t * compatibility, char * reason, size_t reason_size) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(compatibility);
  if (reason == nullptr && reason_size != 0) {
    RMW_SET_ERROR_MSG("reason is null, but reason_size is not 0");
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  return rmw_manycore::guarded([&] {
    const std::string errors = rmw_manycore::errors(publisher_profile, subscription_profile);
    const std::string warnings = rmw_manycore::warnings(publisher_profile, subscription_profile);
    *compatibility = !errors.empty()     ? RMW_QOS_COMPATIBILITY_ERROR
                     : !warnings.empty() ? RMW_QOS_COMPATIBILITY_WARNING
                                         : RMW_QOS_COMPATIBILITY_OK;
    if (reason != nullptr) {
      std::snprintf(reason, reason_size, "%s", (errors + warnings).c_str());
    }
    return RMW_RET_OK;
  });
}
