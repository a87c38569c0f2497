// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <string>

#include "transport/graph.hpp"

namespace manycore::python {

std::string hex(const uint8_t * bytes, size_t count);

nanobind::dict to_dict(const Qos & qos);
nanobind::dict to_dict(const ProcessInfo & process);
nanobind::dict to_dict(const ClusterInfo & cluster);
nanobind::dict to_dict(const CounterValues & counters);

/// Keys as in to_dict(Qos), all optional; TypeError or ValueError in Python for others.
Qos qos_from(const nanobind::dict & values);

}  // namespace manycore::python
