// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Module _rmw_manycore_fields: the type `Array`, which stands in for `array.array` in generated
// message modules. It passes calls on to `array.array`, except those that would copy a buffer
// element by element: these go to a Python function first. In C++, since each message calls it
// twice per sequence when it is constructed. See docs/how-to/large_fields.md.
#include <Python.h>
#include <structmember.h>

#include <cstddef>
#include <cstring>

namespace {

// Shorter buffers are copied sooner by array.array itself.
constexpr Py_ssize_t min_length = 24;

struct Array {
  PyObject_HEAD vectorcallfunc vectorcall;
  PyObject * array_type;  // array.array
  PyObject * convert;     // (typecode, values) -> array.array, or None if array.array has to do it
};

Array * as_array(PyObject * self) { return reinterpret_cast<Array *>(self); }

// Returns whether `values` is an array.array of another type code; its buffer has the code's
// format.
bool has_other_typecode(PyObject * values, PyObject * typecode) {
  const char * wanted = PyUnicode_Check(typecode) ? PyUnicode_AsUTF8(typecode) : nullptr;
  Py_buffer buffer;
  if (wanted == nullptr || PyObject_GetBuffer(values, &buffer, PyBUF_FORMAT) != 0) {
    PyErr_Clear();
    return false;
  }
  const bool is_other = std::strcmp(buffer.format, wanted) != 0;
  PyBuffer_Release(&buffer);
  return is_other;
}

bool is_copied_by_element(const Array * self, PyObject * values, PyObject * typecode) {
  if (!PyObject_CheckBuffer(values) || PyBytes_Check(values) || PyByteArray_Check(values)) {
    return false;
  }
  const Py_ssize_t length = PyObject_Size(values);
  if (length < min_length) {
    PyErr_Clear();  // without a length, as an array of zero dimensions
    return false;
  }
  return Py_TYPE(values) != reinterpret_cast<PyTypeObject *>(self->array_type) ||
         has_other_typecode(values, typecode);
}

PyObject * call(PyObject * callable, PyObject * const * arguments, size_t count, PyObject * names) {
  const Array * self = as_array(callable);
  const bool has_values = PyVectorcall_NARGS(count) == 2 && names == nullptr;
  if (has_values && is_copied_by_element(self, arguments[1], arguments[0])) {
    PyObject * converted = PyObject_Vectorcall(self->convert, arguments, 2, nullptr);
    if (converted != Py_None) {
      return converted;
    }
    Py_DECREF(converted);
  }
  return PyObject_Vectorcall(self->array_type, arguments, count, names);
}

PyObject * create(PyTypeObject * type, PyObject * arguments, PyObject *) {
  PyObject * array_type = nullptr;
  PyObject * convert = nullptr;
  if (!PyArg_ParseTuple(arguments, "O!O", &PyType_Type, &array_type, &convert)) {
    return nullptr;
  }
  PyObject * self = type->tp_alloc(type, 0);
  if (self != nullptr) {
    as_array(self)->vectorcall = call;
    as_array(self)->array_type = Py_NewRef(array_type);
    as_array(self)->convert = Py_NewRef(convert);
  }
  return self;
}

void destroy(PyObject * self) {
  PyTypeObject * type = Py_TYPE(self);
  Py_XDECREF(as_array(self)->array_type);
  Py_XDECREF(as_array(self)->convert);
  type->tp_free(self);
  Py_DECREF(type);
}

PyObject * check_instance(PyObject * self, PyObject * value) {
  const int is_instance = PyObject_IsInstance(value, as_array(self)->array_type);
  return is_instance < 0 ? nullptr : PyBool_FromLong(is_instance);
}

PyMethodDef methods[] = {
  {"__instancecheck__", check_instance, METH_O, "Return whether a value is an array.array."},
  {nullptr, nullptr, 0, nullptr}};

PyMemberDef members[] = {
  {"__vectorcalloffset__", T_PYSSIZET, offsetof(Array, vectorcall), READONLY, nullptr},
  {nullptr, 0, 0, 0, nullptr}};

PyType_Slot slots[] = {
  {Py_tp_doc, const_cast<char *>("Array(array.array, convert): stands in for array.array.")},
  {Py_tp_new, reinterpret_cast<void *>(create)},
  {Py_tp_dealloc, reinterpret_cast<void *>(destroy)},
  {Py_tp_call, reinterpret_cast<void *>(PyVectorcall_Call)},
  {Py_tp_methods, methods},
  {Py_tp_members, members},
  {0, nullptr}};

PyType_Spec spec = {
  "_rmw_manycore_fields.Array", sizeof(Array), 0, Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_VECTORCALL,
  slots};

PyModuleDef definition = {
  PyModuleDef_HEAD_INIT,
  "_rmw_manycore_fields",
  nullptr,
  -1,
  nullptr,
  nullptr,
  nullptr,
  nullptr,
  nullptr};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that Python looks for
PyMODINIT_FUNC PyInit__rmw_manycore_fields() {
  PyObject * module = PyModule_Create(&definition);
  PyObject * type = PyType_FromSpec(&spec);
  if (module == nullptr || type == nullptr || PyModule_AddObject(module, "Array", type) != 0) {
    Py_XDECREF(type);
    Py_XDECREF(module);
    return nullptr;
  }
#ifdef Py_GIL_DISABLED
  PyUnstable_Module_SetGIL(module, Py_MOD_GIL_NOT_USED);  // nothing changes after create()
#endif
  return module;
}
