// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "ndt/common/options.hpp"
#include "ndt/kernel/derivatives.hpp"

namespace manycore::ndt {

/// How an alignment ended.
enum class Outcome : uint32_t {
  converged,
  iteration_limit,  ///< still moving after max_iterations
  no_overlap,       ///< no point has a voxel in range at the resulting pose
  degenerate,       ///< the derivatives are not finite, or all zero
  surpassed,        ///< the coarser levels led to a place where another start was better
  unfinished,       ///< few points converged, but fit too little for the rest to be worth while
};

/// Poses of an alignment: the guess and the pose after each step. Steps beyond the capacity are not
/// kept; an alignment takes about ten.
struct Path {
  static constexpr size_t capacity = 64;

  std::array<Pose6, capacity> poses{};
  uint32_t count = 0;

  void add(const Pose6 & pose) {
    if (count < capacity) {
      poses[count++] = pose;
    }
  }
};

/// Result of an alignment.
struct NewtonResult {
  Outcome outcome = Outcome::iteration_limit;
  uint32_t iterations = 0;
  Pose6 pose{};
  Derivatives at{};     ///< at `pose`
  Derivatives first{};  ///< at the guess
  Path path{};
};

/// Derivatives at a pose; must be deterministic, bit for bit.
using Evaluate = std::function<Derivatives(const Pose6 &)>;

/// Magnusson's algorithm 2: maximises the score by Newton's method, starting from a guess.
NewtonResult maximise(const Pose6 & guess, const MatchOptions & options, const Evaluate & evaluate);

/// Newton's step: the solution s of H s = -g, without the directions in H's null space.
Vector6 newton_step(const Matrix6 & hessian, const Vector6 & gradient);

/// Covariance of a pose by Laplace's approximation: the inverse of the negative Hessian. None where
/// the score has no maximum.
std::optional<Matrix6> laplace_covariance(const Matrix6 & hessian);

}  // namespace manycore::ndt
