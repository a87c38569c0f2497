// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/names.hpp"

#include <string>

#include "platform/error.hpp"
#include "rmw/common/error.hpp"
#include "rmw/validate_full_topic_name.h"
#include "rmw/validate_namespace.h"
#include "rmw/validate_node_name.h"

namespace rmw_manycore {
namespace {

[[noreturn]] void refuse(const char * what, const char * name, const char * reason) {
  throw manycore::Error(
    manycore::ErrorCode::invalid_argument,
    std::string("invalid ") + what + " '" + name + "': " + reason);
}

}  // namespace

void check_node_name(const char * name) {
  int result = RMW_NODE_NAME_VALID;
  check(rmw_validate_node_name(name, &result, nullptr));
  if (result != RMW_NODE_NAME_VALID) {
    refuse("node name", name, rmw_node_name_validation_result_string(result));
  }
}

void check_namespace(const char * ns) {
  int result = RMW_NAMESPACE_VALID;
  check(rmw_validate_namespace(ns, &result, nullptr));
  if (result != RMW_NAMESPACE_VALID) {
    refuse("namespace", ns, rmw_namespace_validation_result_string(result));
  }
}

void check_full_name(const char * name) {
  int result = RMW_TOPIC_VALID;
  check(rmw_validate_full_topic_name(name, &result, nullptr));
  if (result != RMW_TOPIC_VALID) {
    refuse("topic or service name", name, rmw_full_topic_name_validation_result_string(result));
  }
}

void check_endpoint_name(const char * name, const rmw_qos_profile_t & profile) {
  if (*name == '\0') {
    refuse("topic or service name", name, "it is empty");
  }
  if (!profile.avoid_ros_namespace_conventions) {
    check_full_name(name);
  }
}

}  // namespace rmw_manycore
