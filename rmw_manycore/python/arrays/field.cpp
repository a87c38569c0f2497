// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/field.hpp"

#include <sstream>

#include "python/arrays/array_layout.hpp"
#include "python/arrays/owned.hpp"

namespace rmw_manycore {
namespace {

/// A generated class keeps field `data` in slot `_data`.
bool add_slots(Field & field) {
  std::istringstream names(field.path);
  for (std::string name; std::getline(names, name, '.');) {
    PyObject * const slot = PyUnicode_InternFromString(("_" + name).c_str());
    if (slot == nullptr) {
      return false;
    }
    field.slots.push_back(slot);
  }
  return true;
}

bool add_classes(Field & field, PyObject * classes) {
  for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(classes); ++i) {
    PyObject * const nested = PyTuple_GET_ITEM(classes, i);
    if (!PyType_Check(nested)) {
      PyErr_SetString(PyExc_TypeError, "not a class");
      return false;
    }
    field.classes.push_back(reinterpret_cast<PyTypeObject *>(Py_NewRef(nested)));
  }
  return true;
}

}  // namespace

char Field::typecode() const noexcept { return as_array(empty).description->typecode; }

// Types are never unregistered, nor are the references to their objects given up.
bool read_fields(PyObject * described, PyTypeObject * array_type, std::vector<Field> & fields) {
  for (Py_ssize_t i = 0; i < PyList_GET_SIZE(described); ++i) {
    const char * path = nullptr;
    PyObject * typecode = nullptr;
    PyObject * classes = nullptr;
    if (!PyArg_ParseTuple(
          PyList_GET_ITEM(described, i), "sUO!", &path, &typecode, &PyTuple_Type, &classes)) {
      return false;
    }
    Field field;
    field.path = path;
    field.empty =
      PyObject_CallFunctionObjArgs(reinterpret_cast<PyObject *>(array_type), typecode, nullptr);
    if (field.empty == nullptr || !add_slots(field) || !add_classes(field, classes)) {
      return false;
    }
    fields.push_back(std::move(field));
  }
  return true;
}

}  // namespace rmw_manycore
