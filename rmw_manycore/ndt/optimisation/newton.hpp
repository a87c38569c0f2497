// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "ndt/common/options.hpp"
#include "ndt/kernel/derivatives.hpp"

namespace manycore::ndt {

/// How an alignment ended.
enum class Outcome : uint32_t {
  converged,
  iteration_limit,  ///< still moving after max_iterations
  no_overlap,       ///< no point sees a voxel at the pose reached
  degenerate,       ///< the derivatives say nothing: not finite, or all zero
};

/// The way of an alignment: its guess, and the pose after each step. Of steps beyond its capacity
/// nothing is kept; an alignment takes about ten.
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

struct NewtonResult {
  Outcome outcome = Outcome::iteration_limit;
  uint32_t iterations = 0;
  Pose6 pose{};
  Derivatives at{};     ///< this pose
  Derivatives first{};  ///< where the steps began
  Path path{};
};

/// Derivatives at a pose; the same for the same pose, bit for bit.
using Evaluate = std::function<Derivatives(const Pose6 &)>;

/// Magnusson's algorithm 2: Newton's method on the score from a guess.
NewtonResult maximise(const Pose6 & guess, const MatchOptions & options, const Evaluate & evaluate);

/// Newton's step: the solution s of H s = -g, with directions of which H knows nothing left out.
Vector6 newton_step(const Matrix6 & hessian, const Vector6 & gradient);

}  // namespace manycore::ndt
