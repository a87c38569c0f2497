// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

namespace rmw_manycore {

/// Beginning of CPython's struct arraydescr.
struct ArrayDescription {
  char typecode;
  int item_bytes;
};

/// An array.array in memory, as in CPython 3.10 to 3.14.
struct ArrayObject {
  PyVarObject head;
  char * items;  ///< of PyMem_Malloc()
  Py_ssize_t allocated;
  const ArrayDescription * description;
  PyObject * weak_references;
  Py_ssize_t exports;  ///< buffers; while there are any, methods that resize raise BufferError
};

inline ArrayObject & as_array(PyObject * object) noexcept {
  return *reinterpret_cast<ArrayObject *>(object);
}

/// Compares known arrays with the layout above. Null if it is right, else the fault.
const char * find_fault_in_layout(PyTypeObject * array_type);

}  // namespace rmw_manycore
