// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rcutils/allocator.h"
#include "rcutils/types/string_array.h"
#include "rmw/common/error.hpp"
#include "rmw/error_handling.h"

namespace rmw_manycore {

/// A string array of rcutils under construction; freed unless released to the caller.
class StringArray {
public:
  StringArray(size_t size, rcutils_allocator_t allocator) {
    if (rcutils_string_array_init(&array_, size, &allocator) != RCUTILS_RET_OK) {
      throw RmwError(RMW_RET_BAD_ALLOC);  // rcutils has set the error state
    }
  }
  ~StringArray() { ignore(rcutils_string_array_fini(&array_)); }
  StringArray(const StringArray &) = delete;
  StringArray & operator=(const StringArray &) = delete;

  void set(size_t index, const char * text);
  rcutils_string_array_t release() noexcept;

private:
  rcutils_string_array_t array_ = rcutils_get_zero_initialized_string_array();
};

}  // namespace rmw_manycore
