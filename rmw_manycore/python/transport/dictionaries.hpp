// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "transport/registry/graph.hpp"

namespace manycore::python {

std::string hex(const uint8_t * bytes, size_t count);

nanobind::dict to_dict(const Qos & qos);
nanobind::dict to_dict(const ProcessInfo & process);
nanobind::dict to_dict(const ClusterInfo & cluster);
nanobind::dict to_dict(const CounterValues & counters);
/// With the name of its node, which is among `nodes`.
nanobind::dict to_dict(const EndpointInfo & endpoint, const std::vector<NodeInfo> & nodes);

/// From "RIHS01_" and 64 hexadecimal digits; ValueError in Python for anything else.
TypeHash type_hash_from(const std::string & text);

/// Keys as in to_dict(Qos), all optional; TypeError or ValueError in Python for others.
Qos qos_from(const nanobind::dict & values);

}  // namespace manycore::python
