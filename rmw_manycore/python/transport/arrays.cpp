// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/arrays.hpp"

#include <cstring>
#include <utility>

namespace nb = nanobind;

namespace manycore::python {
namespace {

nb::module_ errors() { return nb::module_::import_("rmw_manycore_py.transport.errors"); }

/// Kept until the process ends.
nb::handle numpy(const char * name) {
  return nb::object(nb::module_::import_("numpy").attr(name)).release();
}

}  // namespace

nb::object array_over(
  nb::handle memory, const nb::object & dtype, const nb::object & shape, ptrdiff_t count,
  size_t offset_bytes) {
  static const nb::handle empty = numpy("empty");
  static const nb::handle frombuffer = numpy("frombuffer");
  if (count == 0) {
    return empty(shape, dtype);
  }
  nb::object elements = frombuffer(memory, dtype, count, offset_bytes);
  return nb::len(shape) == 1 ? elements : elements.attr("reshape")(shape);
}

ArrayReader::ArrayReader(nb::object dtype, nb::object layout_of)
: dtype_(std::move(dtype)), layout_of_(std::move(layout_of)) {}

nb::object ArrayReader::array_in(nb::handle message, const uint8_t * data, size_t size_bytes) {
  const bool is_like_last = size_bytes == size_bytes_ && !head_.empty() &&
                            std::memcmp(data, head_.data(), head_.size()) == 0;
  if (!is_like_last) {
    read(message, data, size_bytes);
  }
  return array_over(message, dtype_of_order_, shape_, count_, head_.size());
}

void ArrayReader::read(nb::handle message, const uint8_t * data, size_t size_bytes) {
  const nb::object view = nb::steal(PyMemoryView_FromObject(message.ptr()));
  if (!view) {
    throw nb::python_error();
  }
  const nb::object layout = layout_of_(view, size_bytes, dtype_.attr("itemsize"));
  const bool is_little_endian = nb::cast<bool>(layout.attr("is_little_endian"));
  dtype_of_order_ = is_little_endian ? dtype_ : dtype_.attr("newbyteorder")(">");
  shape_ = layout.attr("shape");
  count_ = nb::cast<ptrdiff_t>(layout.attr("size"));
  const auto head_bytes = nb::cast<size_t>(layout.attr("offset_bytes"));
  head_.assign(reinterpret_cast<const char *>(data), head_bytes);
  size_bytes_ = size_bytes;
}

void raise_error(const char * type, const nb::object & text) {
  PyErr_SetObject(errors().attr(type).ptr(), text.ptr());
  throw nb::python_error();
}

void raise_in_use(const char * constant) {
  raise_error("MessageInUseError", errors().attr(constant));
}

}  // namespace manycore::python
