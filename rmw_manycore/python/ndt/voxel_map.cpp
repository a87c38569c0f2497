// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/voxel_map.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

void init_voxel_map(VoxelMap * map, const DoublePoints & points, const MapOptions & options) {
  const nb::gil_scoped_release released;
  new (map) VoxelMap(build_voxel_map(points.data(), points.shape(0), options));
}

}  // namespace

void bind_voxel_map(nb::module_ & module) {
  nb::class_<VoxelMap>(module, "VoxelMap")
    .def("__init__", &init_voxel_map, nb::arg("points"), nb::arg("options"))
    .def_static(
      "attach",
      [](const std::string & shared_path) { return VoxelMap(SharedMemory::attach(shared_path)); },
      nb::arg("shared_path"))
    .def_prop_ro("shared_path", [](const VoxelMap & map) { return map.memory().shared_path(); })
    .def_prop_ro("voxels", [](const VoxelMap & map) { return map.header().voxel_count; })
    .def_prop_ro("size_bytes", [](const VoxelMap & map) { return map.header().size_bytes; });
}

}  // namespace manycore::ndt::python
