// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace manycore::ndt::python {

/// Each function binds the classes of one source file.
void bind_options(nanobind::module_ & module);
void bind_voxel_map(nanobind::module_ & module);
void bind_results(nanobind::module_ & module);
void bind_matchers(nanobind::module_ & module);
void bind_pairs(nanobind::module_ & module);
void bind_place_search(nanobind::module_ & module);

}  // namespace manycore::ndt::python
