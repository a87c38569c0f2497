// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace manycore::python {

void bind_platform(nanobind::module_ & module);
void bind_configurator(nanobind::module_ & module);
void bind_process(nanobind::module_ & module);

}  // namespace manycore::python
