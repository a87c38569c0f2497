// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>

#include "ndt/kernel/pass.hpp"
#include "platform/error.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

NB_MODULE(_ndt, module) {
  using namespace manycore::ndt;
  module.doc() = "The scan matcher of rmw_manycore; used through rmw_manycore_py.ndt.";
  const nb::exception<manycore::Error> error(module, "NdtError", PyExc_RuntimeError);
  python::bind_options(module);
  python::bind_voxel_map(module);
  python::bind_results(module);
  python::bind_matchers(module);
  python::bind_pairs(module);
  python::bind_place_search(module);
  module.def("simd", [] { return name_of(choose_simd()); });
}
