// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>

#include <exception>

#include "platform/error.hpp"
#include "python/transport/bindings.hpp"
#include "transport/lifecycle/cleaning.hpp"

namespace nb = nanobind;

NB_MODULE(_transport, module) {
  using namespace manycore::python;
  module.doc() =
    "The transport of rmw_manycore without ROS: inspects, configures and joins platforms.";
  const nb::exception<manycore::Error> error(module, "PlatformError", PyExc_RuntimeError);
  const nb::exception<manycore::PlatformInUse> in_use(module, "PlatformInUseError", error);
  bind_qos(module);
  bind_rows(module);
  bind_platform(module);
  bind_configurator(module);
  bind_publisher(module);
  bind_subscription(module);
  bind_process(module);
  bind_trace(module);
}
