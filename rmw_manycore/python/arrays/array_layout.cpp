// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/array_layout.hpp"

#include "python/arrays/owned.hpp"

namespace rmw_manycore {
namespace {

constexpr char typecodes[] = "bBhHiIqQfd";
constexpr Py_ssize_t length = 3;

/// The description is looked at last: a wrong pointer would end the process.
bool is_as_expected(PyObject * object, char typecode) {
  const Owned view(PyMemoryView_FromObject(object));
  if (!view) {
    return false;
  }
  const Py_buffer & buffer = *PyMemoryView_GET_BUFFER(view.get());
  const ArrayObject & array = as_array(object);
  return Py_SIZE(object) == length && array.items == buffer.buf && array.allocated >= length &&
         array.weak_references == nullptr && array.exports == 1 &&
         array.description->typecode == typecode &&
         array.description->item_bytes == buffer.itemsize;
}

bool has_exports_and_weak_references(PyObject * object) {
  if (as_array(object).exports != 0) {
    return false;
  }
  const Owned reference(PyWeakref_NewRef(object, nullptr));
  return reference && as_array(object).weak_references == reference.get();
}

}  // namespace

const char * find_fault_in_layout(PyTypeObject * array_type) {
#ifdef Py_GIL_DISABLED
  return "Python runs without a global interpreter lock";
#endif
  const char * const fault = "this Python lays out array.array in another way";
  if (array_type->tp_basicsize != sizeof(ArrayObject) || array_type->tp_itemsize != 0) {
    return fault;
  }
  auto * const type = reinterpret_cast<PyObject *>(array_type);
  for (const char * typecode = typecodes; *typecode != 0; ++typecode) {
    const Owned array(PyObject_CallFunction(type, "C(iii)", *typecode, 1, 2, 3));
    if (
      !array || !is_as_expected(array.get(), *typecode) ||
      !has_exports_and_weak_references(array.get())) {
      PyErr_Clear();
      return fault;
    }
  }
  return nullptr;
}

}  // namespace rmw_manycore
