// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Module _rmw_manycore_arrays: converters of Python messages that leave large arrays where they
// are: in the record of a taken message, in Python's memory when publishing. Without nanobind,
// since it makes a subclass of array.array. See docs/how-to/zero_copy.md.
#include <Python.h>

#include "python/arrays/array_layout.hpp"
#include "python/arrays/array_types.hpp"
#include "python/arrays/lease.hpp"
#include "python/arrays/owned.hpp"
#include "python/arrays/record_array.hpp"
#include "python/arrays/replacement.hpp"

namespace {

using rmw_manycore::Lease;

rmw_manycore::ArrayTypes array_types{nullptr, nullptr};
const char * fault = nullptr;

PyObject * find_fault(PyObject *, PyObject *) {
  return fault == nullptr ? Py_NewRef(Py_None) : PyUnicode_FromString(fault);
}

PyObject * replace_converters(PyObject *, PyObject * arguments) {
  PyObject * message_class = nullptr;
  PyObject * fields = nullptr;
  int is_read_only = 0;
  if (!PyArg_ParseTuple(
        arguments, "O!O!p", &PyType_Type, &message_class, &PyList_Type, &fields, &is_read_only)) {
    return nullptr;
  }
  auto * const type = reinterpret_cast<PyTypeObject *>(message_class);
  const bool is_done = fault != nullptr || rmw_manycore::replace_converters(
                                             type, fields, array_types, is_read_only != 0);
  return is_done ? Py_NewRef(Py_None) : nullptr;
}

template<void (*function)() noexcept>
PyObject * call(PyObject *, PyObject *) {
  function();
  return Py_NewRef(Py_None);
}

PyMethodDef functions[] = {
  {"find_fault", find_fault, METH_NOARGS, "Return why this Python cannot have it, or None."},
  {"replace_converters", replace_converters, METH_VARARGS,
   "Replace the converters of a message class."},
  {"before_fork", call<Lease::before_fork>, METH_NOARGS, "For os.register_at_fork()."},
  {"after_fork_in_parent", call<Lease::after_fork_in_parent>, METH_NOARGS, "Likewise."},
  {"after_fork_in_child", call<Lease::after_fork_in_child>, METH_NOARGS, "Likewise."},
  {nullptr, nullptr, 0, nullptr}};

PyModuleDef definition = {
  PyModuleDef_HEAD_INIT,
  "_rmw_manycore_arrays",
  nullptr,
  -1,
  functions,
  nullptr,
  nullptr,
  nullptr,
  nullptr};

bool prepare() {
  using rmw_manycore::Owned;
  const Owned module(PyImport_ImportModule("array"));
  Owned type(module ? PyObject_GetAttrString(module.get(), "array") : nullptr);
  if (!type || !PyType_Check(type.get())) {
    return false;
  }
  array_types.plain = reinterpret_cast<PyTypeObject *>(type.release());
  fault = rmw_manycore::find_fault_in_layout(array_types.plain);
  if (fault == nullptr) {
    array_types.in_record = rmw_manycore::make_record_array_type(array_types.plain);
  }
  return fault != nullptr || array_types.in_record != nullptr;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that Python looks for
PyMODINIT_FUNC PyInit__rmw_manycore_arrays() {
  PyObject * const module = prepare() ? PyModule_Create(&definition) : nullptr;
#ifdef Py_GIL_DISABLED
  if (module != nullptr) {  // it changes nothing there: see find_fault_in_layout()
    PyUnstable_Module_SetGIL(module, Py_MOD_GIL_NOT_USED);
  }
#endif
  return module;
}
