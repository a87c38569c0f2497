// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace manycore::python {

/// Makes a class with close() a context manager, which calls close() at the end of the block.
template<typename Class>
void bind_context(nanobind::class_<Class> & bound) {
  bound.def("close", &Class::close)
    .def("__enter__", [](const nanobind::object & self) { return self; })
    .def("__exit__", [](Class & self, const nanobind::args &) { self.close(); });
}

}  // namespace manycore::python
