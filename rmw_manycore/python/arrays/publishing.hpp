// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <vector>

#include "python/arrays/array_types.hpp"
#include "python/arrays/field.hpp"

namespace rmw_manycore {

struct MessageType;

/// The buffers that C messages of this process refer to until they are destroyed. Used with
/// Python's lock only.
class Lending {
public:
  /// Converts `object` as upstream, but lets the message refer to its large arrays. False, with an
  /// exception, on failure.
  static bool convert(MessageType & type, PyObject * object, void * message);
  /// Before the message is destroyed.
  static void take_back(const MessageType & type, void * message) noexcept;
};

}  // namespace rmw_manycore
