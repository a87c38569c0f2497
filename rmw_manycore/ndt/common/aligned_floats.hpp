// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <memory>
#include <new>

#include "ndt/common/alignment.hpp"

namespace manycore::ndt {

/// Floats aligned to 64 bytes. The storage grows and never shrinks; its content is lost when it
/// grows.
class AlignedFloats {
public:
  float * with_room_for(size_t count) {
    if (count > capacity_) {
      const size_t bytes = align_up(count * sizeof(float));
      floats_.reset(static_cast<float *>(std::aligned_alloc(64, bytes)));
      if (!floats_) {
        capacity_ = 0;
        throw std::bad_alloc();
      }
      capacity_ = count;
    }
    return floats_.get();
  }

private:
  struct Free {
    void operator()(float * floats) const noexcept { std::free(floats); }
  };
  std::unique_ptr<float, Free> floats_;
  size_t capacity_ = 0;
};

}  // namespace manycore::ndt
