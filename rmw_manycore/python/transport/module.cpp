// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>

#include <exception>

#include "platform/error.hpp"
#include "python/transport/bindings.hpp"

namespace nb = nanobind;

NB_MODULE(_transport, module) {
  module.doc() =
    "The transport of rmw_manycore without ROS: platforms seen, configured and joined.";
  const nb::exception<manycore::Error> error(module, "PlatformError", PyExc_RuntimeError);
  manycore::python::bind_platform(module);
  manycore::python::bind_configurator(module);
  manycore::python::bind_process(module);
}
