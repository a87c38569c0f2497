// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Python.h>

#include <utility>

namespace rmw_manycore {

/// A reference to a Python object that ends with this.
class Owned {
public:
  Owned() noexcept = default;
  /// Takes over a new reference, which may be null.
  explicit Owned(PyObject * object) noexcept : object_(object) {}
  Owned(Owned && other) noexcept : object_(other.release()) {}
  Owned & operator=(Owned && other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Owned() { Py_XDECREF(object_); }

  static Owned shared(PyObject * object) noexcept { return Owned(Py_NewRef(object)); }

  PyObject * get() const noexcept { return object_; }
  PyObject * release() noexcept { return std::exchange(object_, nullptr); }
  explicit operator bool() const noexcept { return object_ != nullptr; }

private:
  PyObject * object_ = nullptr;
};

}  // namespace rmw_manycore
