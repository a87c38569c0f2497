// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings of the results, which are the kernel's own structs.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <optional>
#include <vector>

#include "ndt/optimisation/newton.hpp"
#include "python/ndt/bindings.hpp"
#include "python/ndt/words.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

template<size_t... Sizes>
using View = nb::ndarray<nb::numpy, const double, nb::shape<Sizes...>, nb::c_contig>;

View<6> gradient(const Derivatives & d) { return View<6>(d.gradient.data(), {6}); }

View<6, 6> hessian(const Derivatives & d) { return View<6, 6>(d.hessian.data(), {6, 6}); }

/// None where the score has no maximum.
nb::object covariance(const Derivatives & d) {
  const std::optional<Matrix6> found = laplace_covariance(d.hessian);
  if (!found) {
    return nb::none();
  }
  return View<6, 6>(found->data(), {6, 6}).cast(nb::rv_policy::copy);
}

nb::object pose(const NewtonResult & result) {
  const Pose4x4 matrix = to_matrix(result.pose);
  return View<4, 4>(matrix.data(), {4, 4}).cast(nb::rv_policy::copy);
}

/// Poses of the iterations, shape (n, 4, 4).
nb::object path(const NewtonResult & result) {
  std::vector<Pose4x4> matrices;
  for (uint32_t i = 0; i < result.path.count; ++i) {
    matrices.push_back(to_matrix(result.path.poses[i]));
  }
  using Poses = nb::ndarray<nb::numpy, const double, nb::shape<-1, 4, 4>, nb::c_contig>;
  return Poses(matrices.data(), {matrices.size(), 4, 4}).cast(nb::rv_policy::copy);
}

}  // namespace

void bind_results(nb::module_ & module) {
  using manycore::python::word;
  nb::class_<Derivatives>(module, "Derivatives")
    .def_ro("score", &Derivatives::score)
    .def_ro("nearest", &Derivatives::nearest)
    .def_ro("pairs", &Derivatives::pairs)
    .def_ro("points", &Derivatives::points)
    .def_ro("scan_points", &Derivatives::scan_points)
    .def_prop_ro("gradient", &gradient, nb::rv_policy::reference_internal)
    .def_prop_ro("hessian", &hessian, nb::rv_policy::reference_internal)
    .def_prop_ro("covariance", &covariance);
  nb::class_<NewtonResult>(module, "NewtonResult")
    .def_prop_ro("outcome", word<NewtonResult>(&NewtonResult::outcome))
    .def_ro("iterations", &NewtonResult::iterations)
    .def_prop_ro("pose", &pose)
    .def_ro("at", &NewtonResult::at)
    .def_ro("first", &NewtonResult::first)
    .def_prop_ro("path", &path);
}

}  // namespace manycore::ndt::python
