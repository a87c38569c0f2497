// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>

#include "platform/error.hpp"
#include "platform/os_process.hpp"
#include "transport/layout/segment_layout.hpp"
#include "transport/process.hpp"

namespace manycore {
namespace {

[[noreturn]] void bad_variable(const char * name, const char * value, const char * expected) {
  throw Error(
    ErrorCode::invalid_argument,
    std::string(name) + "='" + value + "' is not valid: expected " + expected);
}

std::optional<uint32_t> number_from(const char * name, uint32_t least, uint32_t most) {
  const char * const text = std::getenv(name);
  if (text == nullptr || *text == 0) {
    return std::nullopt;
  }
  char * end = nullptr;
  const unsigned long value = std::strtoul(text, &end, 10);
  if (*end != 0 || text[0] == '-' || value < least || value > most) {
    bad_variable(
      name, text,
      ("a whole number from " + std::to_string(least) + " to " + std::to_string(most)).c_str());
  }
  return static_cast<uint32_t>(value);
}

/// As rcl reads it; rcl refuses a value that is not a number.
size_t domain_from_environment() {
  const char * const text = std::getenv("ROS_DOMAIN_ID");
  return text == nullptr ? 0 : std::strtoul(text, nullptr, 0);
}

WaitMode wait_mode_from_environment() {
  const char * const text = std::getenv("MANYCORE_WAIT");
  if (text == nullptr || *text == 0 || std::strcmp(text, "block") == 0) {
    return WaitMode::block;
  }
  if (std::strcmp(text, "adaptive") == 0) {
    return WaitMode::adaptive;
  }
  if (std::strcmp(text, "spin") == 0) {
    return WaitMode::spin;
  }
  bad_variable("MANYCORE_WAIT", text, "block, adaptive or spin");
}

}  // namespace

Placement Placement::from_environment(std::optional<size_t> domain_id) {
  const size_t own_domain = domain_from_environment();
  const size_t domain = domain_id.value_or(own_domain);
  const char * const platform = std::getenv("MANYCORE_PLATFORM");
  const bool is_named = platform != nullptr && *platform != 0;
  const uint32_t cluster = number_from("MANYCORE_CLUSTER", 1, max_clusters).value_or(1);
  const std::optional<uint32_t> core = number_from("MANYCORE_CORE", 0, 1023);
  Placement placement;
  placement.platform = "domain-" + std::to_string(domain);
  if (is_named && domain == own_domain) {
    placement.platform = platform;
  }
  // Cluster and core are those of the named platform; other platforms may lack them.
  if (!is_named || domain == own_domain) {
    placement.cluster = cluster;
    placement.core = core;
  }
  placement.wait_mode = wait_mode_from_environment();
  placement.label = program_name();
  return placement;
}

void Placement::require_on(const Profile & profile) const {
  if (cluster == 0 || cluster > profile.clusters) {
    throw Error(
      ErrorCode::invalid_argument, "there is no cluster " + std::to_string(cluster) +
                                     " on platform '" + platform + "': it has clusters 1 to " +
                                     std::to_string(profile.clusters));
  }
  if (core && *core >= profile.cores_per_cluster) {
    throw Error(
      ErrorCode::invalid_argument, "there is no core " + std::to_string(*core) + " on platform '" +
                                     platform + "': a cluster has cores 0 to " +
                                     std::to_string(profile.cores_per_cluster - 1));
  }
}

}  // namespace manycore
