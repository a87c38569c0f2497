// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/voxel_map.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

VoxelMap * build(
  const DoublePoints & points, double voxel_size_m, Search search, VoxelCovariance covariance,
  uint32_t min_points_per_voxel) {
  const MapOptions options{voxel_size_m, search, covariance, min_points_per_voxel};
  const nb::gil_scoped_release released;
  return new VoxelMap(build_voxel_map(points.data(), points.shape(0), options));
}

}  // namespace

void bind_voxel_map(nb::module_ & module) {
  nb::enum_<Search>(module, "Search")
    .value("radius", Search::radius)
    .value("direct7", Search::direct7)
    .value("direct1", Search::direct1);
  nb::enum_<VoxelCovariance>(module, "VoxelCovariance")
    .value("pcl", VoxelCovariance::pcl)
    .value("autoware", VoxelCovariance::autoware)
    .value("pclomp", VoxelCovariance::pclomp);
  nb::class_<VoxelMap>(module, "VoxelMap")
    .def(
      nb::new_(&build), nb::arg("points"), nb::kw_only(), nb::arg("voxel_size_m"),
      nb::arg("search"), nb::arg("covariance"), nb::arg("min_points_per_voxel"))
    .def_prop_ro("voxels", [](const VoxelMap & map) { return map.header().voxel_count; })
    .def_prop_ro("size_bytes", [](const VoxelMap & map) { return map.header().size_bytes; });
}

}  // namespace manycore::ndt::python
