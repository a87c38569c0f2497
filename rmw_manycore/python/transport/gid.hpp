// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include "transport/layout/endpoint.hpp"

namespace manycore::python {

/// A gid as 16 bytes in Python.
inline nanobind::bytes to_bytes(const Gid & gid) { return nanobind::bytes(gid.data(), gid.size()); }

}  // namespace manycore::python
