// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace rmw_manycore {

/// A sequence of numbers that each message of a type has once: a field of the message itself or of
/// messages nested in it, not of elements. rclpy keeps its values as array.array.
struct NumberSequence {
  std::string path;  ///< names of the fields from the outermost to this one: "image.data"
  char typecode;     ///< of array.array
  size_t offset;     ///< in the message in memory
};

}  // namespace rmw_manycore
