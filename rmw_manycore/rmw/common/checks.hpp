// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "rmw/check_type_identifiers_match.h"
#include "rmw/common/identifier.hpp"
#include "rmw/error_handling.h"

/// Invariants shared by most entry points. Macros, because each returns from its caller.

/// The handle is not null and belongs to this RMW.
#define MANYCORE_CHECK_HANDLE(handle)                                      \
  RMW_CHECK_ARGUMENT_FOR_NULL(handle, RMW_RET_INVALID_ARGUMENT);           \
  RMW_CHECK_TYPE_IDENTIFIERS_MATCH(                                        \
    handle, (handle)->implementation_identifier, rmw_manycore::identifier, \
    return RMW_RET_INCORRECT_RMW_IMPLEMENTATION)

/// The same, for functions that return a handle.
#define MANYCORE_CHECK_HANDLE_OR_NULL(handle)   \
  RMW_CHECK_ARGUMENT_FOR_NULL(handle, nullptr); \
  RMW_CHECK_TYPE_IDENTIFIERS_MATCH(             \
    handle, (handle)->implementation_identifier, rmw_manycore::identifier, return nullptr)

#define MANYCORE_CHECK_ARGUMENT(argument) \
  RMW_CHECK_ARGUMENT_FOR_NULL(argument, RMW_RET_INVALID_ARGUMENT)

#define MANYCORE_CHECK_ALLOCATOR(allocator) \
  RCUTILS_CHECK_ALLOCATOR_WITH_MSG(         \
    allocator, "allocator argument is invalid", return RMW_RET_INVALID_ARGUMENT)

#define MANYCORE_CHECK_ZERO_STRING_ARRAY(array)               \
  if (rmw_check_zero_rmw_string_array(array) != RMW_RET_OK) { \
    return RMW_RET_INVALID_ARGUMENT;                          \
  }

#define MANYCORE_CHECK_ZERO_NAMES_AND_TYPES(names_and_types)           \
  if (rmw_names_and_types_check_zero(names_and_types) != RMW_RET_OK) { \
    return RMW_RET_INVALID_ARGUMENT;                                   \
  }
