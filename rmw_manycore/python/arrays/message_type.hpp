// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <vector>

#include "python/arrays/field.hpp"
#include "python/arrays/publishing.hpp"
#include "python/arrays/taking.hpp"
#include "rmw/borrowing/interface.hpp"

namespace rmw_manycore {

/// The functions in the capsules of a generated class, with which rclpy handles its messages.
struct Converters {
  void * (*create)();
  void (*destroy)(void * message);
  bool (*from_python)(PyObject * object, void * message);
  PyObject * (*to_python)(void * message);
};

/// A message class whose converters were replaced: upstream's, and what they do less or more.
struct MessageType {
  const BorrowingInterface & interface;
  Converters upstream;
  PyTypeObject * message_class;
  const void * type_support;
  std::vector<Field> fields;
  ArrayTypes arrays;
  bool is_read_only;  ///< default of taken arrays; a topic may override it

  void * create() const noexcept;
  void destroy(void * message) const noexcept;
  bool from_python(PyObject * object, void * message) noexcept;
  PyObject * to_python(void * message) const noexcept;
};

}  // namespace rmw_manycore
