// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/string_array.hpp"

#include <new>
#include <utility>

#include "rcutils/strdup.h"

namespace rmw_manycore {

void StringArray::set(size_t index, const char * text) {
  array_.data[index] = rcutils_strdup(text, array_.allocator);
  if (array_.data[index] == nullptr) {
    throw std::bad_alloc();
  }
}

rcutils_string_array_t StringArray::release() noexcept {
  return std::exchange(array_, rcutils_get_zero_initialized_string_array());
}

}  // namespace rmw_manycore
