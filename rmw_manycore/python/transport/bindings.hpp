// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace manycore::python {

/// Each function binds the classes of one source file.
void bind_qos(nanobind::module_ & module);
void bind_rows(nanobind::module_ & module);
void bind_platform(nanobind::module_ & module);
void bind_configurator(nanobind::module_ & module);
void bind_publisher(nanobind::module_ & module);
void bind_subscription(nanobind::module_ & module);
void bind_trace(nanobind::module_ & module);
void bind_process(nanobind::module_ & module);

}  // namespace manycore::python
