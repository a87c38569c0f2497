// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ndt/common/options.hpp"
#include "ndt/optimisation/newton.hpp"
#include "python/words.hpp"

namespace manycore::python {

/// Words of the scan matcher's enumerations in Python.
template<>
struct Words<ndt::Search> {
  static constexpr const char * name = "search";
  static constexpr std::array<const char *, 3> all = {"radius", "direct7", "direct1"};
};

template<>
struct Words<ndt::VoxelCovariance> {
  static constexpr const char * name = "covariance";
  static constexpr std::array<const char *, 3> all = {"pcl", "autoware", "pclomp"};
};

template<>
struct Words<ndt::StepRule> {
  static constexpr const char * name = "step_rule";
  static constexpr std::array<const char *, 3> all = {"trust_region", "clamped", "more_thuente"};
};

template<>
struct Words<ndt::Outcome> {
  static constexpr const char * name = "outcome";
  static constexpr std::array<const char *, 6> all = {
    "converged", "iteration_limit", "no_overlap", "degenerate", "surpassed", "unfinished"};
};

}  // namespace manycore::python
