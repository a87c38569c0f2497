// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/search/place_search.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <utility>

#include "ndt/search/search_map.hpp"
#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using Place = std::tuple<double, double, double, double, uint32_t>;

void init_options(
  SearchOptions * options, uint32_t yaws, uint32_t kept_permille,
  const std::pair<double, double> & centre_m, double radius_m, uint32_t first_yaw,
  uint32_t searched_yaws) {
  new (options) SearchOptions{yaws,     kept_permille, {centre_m.first, centre_m.second},
                              radius_m, first_yaw,     searched_yaws};
}

void init_search(
  PlaceSearch * search, const SearchMap & map, const FloatPoints & points,
  const SearchOptions & options) {
  const nb::gil_scoped_release released;
  new (search) PlaceSearch(map, points.data(), points.shape(0), options);
}

std::vector<Place> found(const PlaceSearch & search, size_t limit) {
  std::vector<Place> places;
  for (const FoundPlace & one : search.found(limit)) {
    places.emplace_back(one.x_m, one.y_m, one.ground_m, one.yaw_rad, one.points);
  }
  return places;
}

}  // namespace

void bind_place_search(nb::module_ & module) {
  nb::class_<SearchMap>(module, "SearchMap")
    .def(
      "__init__",
      [](SearchMap * map, const VoxelMap & from) {
        const nb::gil_scoped_release released;
        new (map) SearchMap(build_search_map(from));
      },
      nb::arg("voxel_map"))
    .def_static("bytes_for", &search_map_bytes, nb::arg("voxel_map"));
  nb::class_<SearchOptions>(module, "SearchOptions")
    .def(
      "__init__", &init_options, nb::kw_only(), nb::arg("yaws"), nb::arg("kept_permille"),
      nb::arg("centre_m"), nb::arg("radius_m"), nb::arg("first_yaw"), nb::arg("searched_yaws"));
  nb::class_<PlaceSearch>(module, "PlaceSearch")
    .def(
      "__init__", &init_search, nb::arg("search_map"), nb::arg("points"), nb::arg("options"),
      nb::keep_alive<1, 2>())
    .def_static(
      "bytes_for", &search_bytes, nb::arg("search_map"), nb::arg("points"), nb::arg("options"))
    .def("order_roots", &PlaceSearch::order_roots)
    .def("found", &found, nb::arg("limit"));
}

}  // namespace manycore::ndt::python
