// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include "python/arrays/array_types.hpp"

namespace rmw_manycore {

/// Replaces the converters of a message class, which has imported its type support; `fields` as
/// read_fields() takes them. Without librmw_manycore.so, or beyond the number of types, upstream's
/// stay. False, with an exception, on failure.
bool replace_converters(
  PyTypeObject * message_class, PyObject * fields, const ArrayTypes & arrays, bool is_read_only);

}  // namespace rmw_manycore
