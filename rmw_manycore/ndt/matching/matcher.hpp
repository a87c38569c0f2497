// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "ndt/kernel/pass.hpp"
#include "ndt/kernel/scan.hpp"
#include "ndt/optimisation/newton.hpp"

namespace manycore::ndt {

/// What is matched: a scan to a map.
struct Problem {
  MapView map;
  ScanView scan;
  MatchOptions options;
  std::optional<Regularization> regularization;
};

/// d2 of eq. 6.8 as the kernel takes it.
float kernel_d2(const Problem & problem);

/// All bins' sums added in the order of the bins, whoever computed them.
TangentSums add_bins(const TangentSums (&bins)[bin_count]);

/// Derivatives at a pose, from the sums of all bins there.
Derivatives finish_pass(const Problem & problem, const TangentSums & sums, const Pose6 & pose);

/// One core does all bins.
Derivatives evaluate_alone(const Problem & problem, const Kernel & kernel, const Pose6 & pose);

}  // namespace manycore::ndt
