// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>

#include "ndt/matching/matcher.hpp"
#include "ndt/optimisation/newton.hpp"
#include "ndt/search/place_search.hpp"
#include "platform/clock.hpp"
#include "python/ndt/arrays.hpp"

namespace manycore::ndt::python {

using Maps = std::vector<const VoxelMap *>;

/// A matcher bound to Python; releases the GIL while it computes.
template<typename Matcher>
class Bound {
public:
  template<typename... More>
  explicit Bound(const MatchOptions & options, const More &... more)
  : scale_factor_(options.regularization_scale_factor), matcher_(options, more...) {}

  NewtonResult align(
    const Maps & maps, const FloatPoints & points, const PoseMatrix & guess,
    const std::optional<std::pair<double, double>> & position_m, size_t first, size_t polishing,
    double surpassed, double min_fit) {
    std::optional<Regularization> regularization;
    if (position_m) {
      regularization = Regularization{scale_factor_, position_m->first, position_m->second};
    }
    const nanobind::gil_scoped_release released;
    const Levels levels{maps, first, polishing, surpassed, min_fit};
    return matcher_.align(levels, points.data(), points.shape(0), pose_from(guess), regularization);
  }

  Derivatives evaluate(
    const Maps & maps, const FloatPoints & points, const PoseMatrix & pose, size_t polishing) {
    const nanobind::gil_scoped_release released;
    const Levels levels{maps, 0, polishing};
    return matcher_.evaluate(levels, points.data(), points.shape(0), pose_from(pose));
  }

  bool search(PlaceSearch & search, bool descends, double for_s) {
    const nanobind::gil_scoped_release released;
    const SearchPhase phase = descends ? SearchPhase::descend : SearchPhase::bound;
    return matcher_.search(search, phase, static_cast<int64_t>(for_s * ns_per_s));
  }

  Matcher & matcher() { return matcher_; }

private:
  double scale_factor_;
  Matcher matcher_;
};

/// Binds the methods common to all matchers.
template<typename Matcher>
nanobind::class_<Bound<Matcher>> bind_matcher(nanobind::module_ & module, const char * name) {
  using Self = Bound<Matcher>;
  return nanobind::class_<Self>(module, name)
    .def(
      "align", &Self::align, nanobind::arg("maps"), nanobind::arg("points"), nanobind::arg("guess"),
      nanobind::arg("regularization_position_m") = nanobind::none(), nanobind::arg("first") = 0,
      nanobind::arg("polishing") = 0, nanobind::arg("surpassed") = Levels::no_score,
      nanobind::arg("min_fit") = Levels::no_score)
    .def(
      "evaluate", &Self::evaluate, nanobind::arg("maps"), nanobind::arg("points"),
      nanobind::arg("pose"), nanobind::arg("polishing") = 0);
}

/// Binds a matcher that also searches places.
template<typename Matcher>
nanobind::class_<Bound<Matcher>> bind_searcher(nanobind::module_ & module, const char * name) {
  return bind_matcher<Matcher>(module, name)
    .def(
      "search", &Bound<Matcher>::search, nanobind::arg("search"), nanobind::arg("descends"),
      nanobind::arg("for_s"));
}

}  // namespace manycore::ndt::python
