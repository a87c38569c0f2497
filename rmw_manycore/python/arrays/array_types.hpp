// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

namespace rmw_manycore {

struct ArrayTypes {
  PyTypeObject * plain;      ///< array.array
  PyTypeObject * in_record;  ///< see record_array.hpp

  bool have(PyObject * object) const noexcept {
    return Py_TYPE(object) == plain || Py_TYPE(object) == in_record;
  }
};

}  // namespace rmw_manycore
