// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/voxel_map.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include "ndt/kernel/evidence.hpp"
#include "ndt/kernel/point_scores.hpp"
#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

void init_voxel_map(
  VoxelMap * map, const DoublePoints & points, const MapOptions & options, size_t without_every) {
  const nb::gil_scoped_release released;
  new (map) VoxelMap(build_voxel_map(points.data(), points.shape(0), options, without_every));
}

nb::ndarray<nb::numpy, float, nb::ndim<1>> scores_of_points(
  const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose, double outlier_ratio) {
  const size_t count = points.shape(0);
  auto * const scores = new float[count];
  const nb::capsule owner(scores, [](void * p) noexcept { delete[] static_cast<float *>(p); });
  {
    const nb::gil_scoped_release released;
    point_scores(map.view(), outlier_ratio, pose_from(pose), points.data(), count, scores);
  }
  return nb::ndarray<nb::numpy, float, nb::ndim<1>>(scores, {count}, owner);
}

nb::ndarray<nb::numpy, float, nb::shape<-1, 4>> evidence_of_points(
  const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose, double outlier_ratio) {
  const size_t count = points.shape(0);
  auto * const evidence = new PointEvidence[count];
  const nb::capsule owner(
    evidence, [](void * p) noexcept { delete[] static_cast<PointEvidence *>(p); });
  {
    const nb::gil_scoped_release released;
    point_evidence(map.view(), outlier_ratio, pose_from(pose), points.data(), count, evidence);
  }
  return nb::ndarray<nb::numpy, float, nb::shape<-1, 4>>(&evidence->score, {count, 4}, owner);
}

nb::ndarray<nb::numpy, uint8_t, nb::ndim<1>> columns_around_points(
  const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose) {
  const size_t count = points.shape(0);
  auto * const around = new uint8_t[count];
  const nb::capsule owner(around, [](void * p) noexcept { delete[] static_cast<uint8_t *>(p); });
  {
    const nb::gil_scoped_release released;
    columns_around(map.view(), pose_from(pose), points.data(), count, around);
  }
  return nb::ndarray<nb::numpy, uint8_t, nb::ndim<1>>(around, {count}, owner);
}

}  // namespace

void bind_voxel_map(nb::module_ & module) {
  nb::class_<VoxelMap>(module, "VoxelMap")
    .def(
      "__init__", &init_voxel_map, nb::arg("points"), nb::arg("options"),
      nb::arg("without_every") = 0)
    .def(
      "point_scores", &scores_of_points, nb::arg("points"), nb::arg("pose"),
      nb::arg("outlier_ratio"))
    .def(
      "point_evidence", &evidence_of_points, nb::arg("points"), nb::arg("pose"),
      nb::arg("outlier_ratio"))
    .def("columns_around", &columns_around_points, nb::arg("points"), nb::arg("pose"))
    .def_static(
      "attach",
      [](const std::string & shared_path) { return VoxelMap(SharedMemory::attach(shared_path)); },
      nb::arg("shared_path"))
    .def_prop_ro("shared_path", [](const VoxelMap & map) { return map.memory().shared_path(); })
    .def_prop_ro("voxels", [](const VoxelMap & map) { return map.header().voxel_count; })
    .def_prop_ro("size_bytes", [](const VoxelMap & map) { return map.header().size_bytes; });
}

}  // namespace manycore::ndt::python
