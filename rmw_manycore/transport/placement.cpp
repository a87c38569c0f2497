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

Placement Placement::from_environment(size_t domain_id) {
  Placement placement;
  const char * const platform = std::getenv("MANYCORE_PLATFORM");
  placement.platform =
    platform != nullptr && *platform != 0 ? platform : "domain-" + std::to_string(domain_id);
  placement.cluster = number_from("MANYCORE_CLUSTER", 1, max_clusters).value_or(1);
  placement.core = number_from("MANYCORE_CORE", 0, 1023);
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
