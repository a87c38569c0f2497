// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <string>

namespace manycore::python {

/// A text of the registry; bytes that are not UTF-8 become U+FFFD.
inline nanobind::str text(const std::string & bytes) {
  PyObject * const decoded =
    PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
  if (decoded == nullptr) {
    nanobind::raise_python_error();
  }
  return nanobind::steal<nanobind::str>(decoded);
}

/// Getter for def_prop_ro: a text member of `Row` or of its base class.
template<typename Row, typename Owner>
auto name(std::string Owner::*member) {
  return [member](const Row & row) { return text(row.*member); };
}

}  // namespace manycore::python
