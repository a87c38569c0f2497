// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "rmw/names_and_types.h"
#include "transport/registry/graph.hpp"

namespace rmw_manycore {

/// Topics or services with their types, both sorted and unique.
using NamesAndTypes = std::map<std::string, std::set<std::string>>;

/// Names and types of the endpoints selected by `wanted`.
template<typename Predicate>
NamesAndTypes names_and_types(
  const std::vector<manycore::EndpointInfo> & endpoints, Predicate && wanted) {
  NamesAndTypes result;
  for (const manycore::EndpointInfo & endpoint : endpoints) {
    if (wanted(endpoint)) {
      result[endpoint.topic].insert(endpoint.type);
    }
  }
  return result;
}

/// True if a topic is listed. Names without a leading slash are not ROS names.
inline bool is_shown(const manycore::EndpointInfo & endpoint, bool no_demangle) {
  return endpoint.role == manycore::EndpointRole::topic &&
         (no_demangle || endpoint.topic.front() == '/');
}

/// Fills the zero-initialized `result`. Leaves it unchanged if `found` is empty or on failure.
void write(
  const NamesAndTypes & found, rcutils_allocator_t & allocator, rmw_names_and_types_t & result);

}  // namespace rmw_manycore
