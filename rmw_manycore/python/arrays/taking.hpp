// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <vector>

#include "python/arrays/array_types.hpp"
#include "python/arrays/field.hpp"
#include "rmw/borrowing/interface.hpp"

namespace rmw_manycore {

/// Gives the converted `object` the sequences that `message` left in its record: as arrays in the
/// record if their access allows it, else as copies. False, with an exception, on failure.
bool set_borrowed(
  const BorrowingInterface & interface, const ArrayTypes & arrays,
  const std::vector<Field> & fields, void * message, PyObject * object);

}  // namespace rmw_manycore
