// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace rmw_manycore {

/// A field of a message class whose value is an array.array.
struct Field {
  static constexpr size_t unknown = SIZE_MAX - 1;
  static constexpr size_t none = SIZE_MAX;

  std::string path;                     ///< as NumberSequence::path
  std::vector<PyObject *> slots;        ///< names of the attributes on the way, "_data" last
  std::vector<PyTypeObject *> classes;  ///< of the nested messages on the way
  PyObject * empty;                     ///< an array.array of the field's type code
  size_t offset = unknown;              ///< in the C message; `none` if it cannot be found

  char typecode() const noexcept;
};

/// `described` is a list of (path, type code, classes). False, with an exception, on failure.
bool read_fields(PyObject * described, PyTypeObject * array_type, std::vector<Field> & fields);

}  // namespace rmw_manycore
