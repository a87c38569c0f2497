// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <cstddef>

#include "python/arrays/lease.hpp"

namespace rmw_manycore {

/// The type of arrays that lie in a record: a subclass of array.array. Methods that resize first
/// copy the elements to memory of Python. Null, with an exception, on failure.
PyTypeObject * make_record_array_type(PyTypeObject * array_type);

/// Elements of an array in a record.
struct RecordItems {
  void * items;
  size_t count;
  bool is_read_only;  ///< what would change them raises an exception
};

/// An array over elements in the lease's record; `like` is an array.array with its type code. Null,
/// with an exception, on failure.
PyObject * make_record_array(
  PyTypeObject * type, PyObject * like, const RecordItems & items, Lease & lease);

}  // namespace rmw_manycore
