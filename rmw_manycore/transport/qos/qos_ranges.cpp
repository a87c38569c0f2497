// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/qos/qos_ranges.hpp"

#include <string>

#include "platform/error.hpp"

namespace manycore {
namespace {

void check_duration(const EndpointSpec & spec, int64_t ns, const char * what) {
  if (ns <= 0) {
    throw Error(
      ErrorCode::invalid_argument, std::string("the ") + what + " of " + std::to_string(ns) +
                                     " ns for '" + spec.topic +
                                     "' is out of range: expected more than 0");
  }
}

}  // namespace

void check_qos_ranges(const EndpointSpec & spec) {
  check_duration(spec, spec.qos.deadline_ns, "deadline");
  check_duration(spec, spec.qos.lifespan_ns, "lifespan");
  check_duration(spec, spec.qos.liveliness_lease_ns, "liveliness lease duration");
  constexpr uint32_t most = 1u << 20;
  const bool is_bounded = spec.qos.history == History::keep_last;
  if (spec.qos.depth == 0 || (is_bounded && spec.qos.depth > most)) {
    throw Error(
      ErrorCode::invalid_argument, "history depth " + std::to_string(spec.qos.depth) + " for '" +
                                     spec.topic + "' is out of range: expected 1 to " +
                                     std::to_string(most));
  }
}

}  // namespace manycore
