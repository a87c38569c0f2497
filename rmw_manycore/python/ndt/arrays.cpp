// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/ndt/arrays.hpp"

#include <algorithm>

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

template<typename Numbers>
nb::list list_of(const Numbers & numbers) {
  nb::list out;
  for (const double number : numbers) {
    out.append(number);
  }
  return out;
}

}  // namespace

Pose6 pose_from(const PoseMatrix & matrix) {
  Pose4x4 rows;
  std::copy_n(matrix.data(), rows.size(), rows.begin());
  return to_pose6(rows);
}

nb::dict to_dict(const Derivatives & d) {
  nb::dict out;
  out["score"] = d.score;
  out["nearest"] = d.nearest;
  out["pairs"] = d.pairs;
  out["points"] = d.points;
  out["gradient"] = list_of(d.gradient);
  nb::list rows;
  for (const Vector6 & row : d.hessian) {
    rows.append(list_of(row));
  }
  out["hessian"] = rows;
  return out;
}

nb::dict to_dict(const NewtonResult & result) {
  constexpr const char * outcomes[] = {"converged", "iteration_limit", "no_overlap", "degenerate"};
  nb::dict out = to_dict(result.at);
  out["outcome"] = outcomes[static_cast<size_t>(result.outcome)];
  out["iterations"] = result.iterations;
  out["pose"] = list_of(to_matrix(result.pose));
  return out;
}

}  // namespace manycore::ndt::python
