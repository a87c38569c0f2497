// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace manycore::python {

/// A numpy array over an object with the buffer protocol, of which it is a view. -1 as `count`:
/// all elements from the offset on.
nanobind::object array_over(
  nanobind::handle memory, const nanobind::object & dtype, const nanobind::object & shape,
  ptrdiff_t count, size_t offset_bytes);

/// Makes arrays over messages, whose heads are mostly like the one before.
class ArrayReader {
public:
  /// `layout_of(view, size_bytes, itemsize)` reads a head that differs.
  ArrayReader(nanobind::object dtype, nanobind::object layout_of);

  nanobind::object array_in(nanobind::handle message, const uint8_t * data, size_t size_bytes);

private:
  void read(nanobind::handle message, const uint8_t * data, size_t size_bytes);

  const nanobind::object dtype_;
  const nanobind::object layout_of_;
  // Of the last message:
  size_t size_bytes_ = 0;
  std::string head_;  ///< all that is before the elements
  nanobind::object dtype_of_order_;
  nanobind::object shape_;
  ptrdiff_t count_ = 0;
};

/// Raises an error of rmw_manycore_py.transport.errors, with a text or a constant from there.
[[noreturn]] void raise_error(const char * type, const nanobind::object & text);
[[noreturn]] void raise_in_use(const char * constant);

}  // namespace manycore::python
