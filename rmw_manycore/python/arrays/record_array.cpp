// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/record_array.hpp"

#include <cstring>
#include <utility>
#include <vector>

#include "python/arrays/array_layout.hpp"
#include "python/arrays/owned.hpp"

namespace rmw_manycore {
namespace {

struct RecordArray {
  ArrayObject array;
  Lease * lease;  ///< null: the elements are in memory of Python, as of any array.array
  bool is_read_only;
};

PyTypeObject * array_type = nullptr;  ///< array.array

Lease *& lease_of(PyObject * self) noexcept { return reinterpret_cast<RecordArray *>(self)->lease; }

template<typename Function>
Function upstream(int slot) noexcept {
  return reinterpret_cast<Function>(PyType_GetSlot(array_type, slot));
}

void leave_record(PyObject * self, char * items) noexcept {
  as_array(self).items = items;
  as_array(self).exports -= 1;  // that of the record
  std::exchange(lease_of(self), nullptr)->give_back();
}

/// Before a method that changes elements in place. False, with an exception, if it must not.
bool may_write(PyObject * self) noexcept {
  if (reinterpret_cast<RecordArray *>(self)->is_read_only) {
    PyErr_SetString(
      PyExc_TypeError,
      "the array is read-only, since other readers may see it (zero_copy: read_only): change a "
      "copy, such as array[:]");
    return false;
  }
  return true;
}

/// Before a method that resizes. While other buffers are exported, array.array itself refuses.
bool copy_out(PyObject * self) {
  ArrayObject & array = as_array(self);
  if (!may_write(self)) {
    return false;
  }
  if (lease_of(self) == nullptr || array.exports > 1) {
    return true;
  }
  const size_t bytes = static_cast<size_t>(Py_SIZE(self)) * array.description->item_bytes;
  auto * const items = static_cast<char *>(PyMem_Malloc(bytes));
  if (items == nullptr) {
    PyErr_NoMemory();
    return false;
  }
  std::memcpy(items, array.items, bytes);
  leave_record(self, items);
  return true;
}

void destroy(PyObject * self) {
  if (lease_of(self) != nullptr) {
    leave_record(self, nullptr);
  }
  upstream<destructor>(Py_tp_dealloc)(self);
}

template<const char * name>
PyObject * call(PyObject * self, PyObject * arguments, PyObject * named) {
  const Owned method(PyObject_GetAttrString(reinterpret_cast<PyObject *>(array_type), name));
  // CPython 3.11 reads the type, which its documentation calls optional.
  const Owned bound(
    method ? PyObject_CallMethod(method.get(), "__get__", "OO", self, Py_TYPE(self)) : nullptr);
  return bound ? PyObject_Call(bound.get(), arguments, named) : nullptr;
}

/// array.array's method of this name, after copy_out().
template<const char * name>
PyObject * resize(PyObject * self, PyObject * arguments, PyObject * named) {
  return copy_out(self) ? call<name>(self, arguments, named) : nullptr;
}

/// array.array's method of this name, which changes elements in place.
template<const char * name>
PyObject * change(PyObject * self, PyObject * arguments, PyObject * named) {
  return may_write(self) ? call<name>(self, arguments, named) : nullptr;
}

/// As array.array, so that pickles load without this module.
PyObject * reduce(PyObject * self, PyObject * protocol) {
  const Owned plain(PyObject_CallMethod(self, "__copy__", nullptr));
  return plain ? PyObject_CallMethod(plain.get(), "__reduce_ex__", "O", protocol) : nullptr;
}

PyObject * concatenate(PyObject * self, PyObject * other) {
  return copy_out(self) ? upstream<binaryfunc>(Py_sq_inplace_concat)(self, other) : nullptr;
}

PyObject * repeat(PyObject * self, Py_ssize_t count) {
  return copy_out(self) ? upstream<ssizeargfunc>(Py_sq_inplace_repeat)(self, count) : nullptr;
}

int assign_item(PyObject * self, Py_ssize_t index, PyObject * value) {
  if (!may_write(self) || (value == nullptr && !copy_out(self))) {
    return -1;
  }
  return upstream<ssizeobjargproc>(Py_sq_ass_item)(self, index, value);
}

/// Whether an assignment replaces elements one by one. Without any, array.array may still resize.
bool keeps_length(PyObject * self, PyObject * key, PyObject * value) {
  if (value == nullptr) {
    return false;
  }
  if (!PySlice_Check(key)) {
    return true;
  }
  Py_ssize_t begin = 0;
  Py_ssize_t end = 0;
  Py_ssize_t step = 0;
  if (!PyObject_TypeCheck(value, array_type) || PySlice_Unpack(key, &begin, &end, &step) != 0) {
    PyErr_Clear();  // array.array raises it
    return false;
  }
  const Py_ssize_t count = PySlice_AdjustIndices(Py_SIZE(self), &begin, &end, step);
  return count != 0 && count == Py_SIZE(value);
}

int assign(PyObject * self, PyObject * key, PyObject * value) {
  if (!may_write(self) || (!keeps_length(self, key, value) && !copy_out(self))) {
    return -1;
  }
  return upstream<objobjargproc>(Py_mp_ass_subscript)(self, key, value);
}

int get_buffer(PyObject * self, Py_buffer * view, int flags) {
  const bool is_read_only = reinterpret_cast<RecordArray *>(self)->is_read_only;
  if (is_read_only && (flags & PyBUF_WRITABLE) != 0) {
    view->obj = nullptr;
    PyErr_SetString(PyExc_BufferError, "the array is read-only (zero_copy: read_only)");
    return -1;
  }
  const int result = array_type->tp_as_buffer->bf_getbuffer(self, view, flags);
  if (result == 0 && is_read_only) {
    view->readonly = 1;
  }
  return result;
}

template<const char * name>
PyMethodDef method(PyCFunctionWithKeywords function) {
  return {
    name, reinterpret_cast<PyCFunction>(reinterpret_cast<void *>(function)),
    METH_VARARGS | METH_KEYWORDS, "As of array.array."};
}
template<const char * name>
PyMethodDef resizing() {
  return method<name>(resize<name>);
}
template<const char * name>
PyMethodDef changing() {
  return method<name>(change<name>);
}

constexpr char append[] = "append", clear[] = "clear", extend[] = "extend",
               frombytes[] = "frombytes", fromfile[] = "fromfile", fromlist[] = "fromlist",
               fromunicode[] = "fromunicode", insert[] = "insert", pop[] = "pop",
               remove[] = "remove", byteswap[] = "byteswap", reverse[] = "reverse";

/// Those that this Python's array.array has.
PyMethodDef * methods() {
  static std::vector<PyMethodDef> methods;
  for (const PyMethodDef & method :
       {resizing<append>(), resizing<clear>(), resizing<extend>(), resizing<frombytes>(),
        resizing<fromfile>(), resizing<fromlist>(), resizing<fromunicode>(), resizing<insert>(),
        resizing<pop>(), resizing<remove>(), changing<byteswap>(), changing<reverse>()}) {
    if (PyObject_HasAttrString(reinterpret_cast<PyObject *>(array_type), method.ml_name)) {
      methods.push_back(method);
    }
  }
  methods.push_back({"__reduce_ex__", reduce, METH_O, "As of array.array."});
  methods.push_back({nullptr, nullptr, 0, nullptr});
  return methods.data();
}

/// The type of arrays in records equals array.array: programs look for `type(value)` in lists and
/// sets of types.
PyObject * compare_types(PyObject * self, PyObject * other, int operation) {
  if (operation != Py_EQ && operation != Py_NE) {
    return Py_NewRef(Py_NotImplemented);
  }
  const bool is_equal = other == self || other == reinterpret_cast<PyObject *>(array_type);
  return PyBool_FromLong(static_cast<long>(is_equal == (operation == Py_EQ)));
}

Py_hash_t hash_type(PyObject *) { return PyObject_Hash(reinterpret_cast<PyObject *>(array_type)); }

PyObject * make_metaclass() {
  PyType_Slot slots[] = {
    {Py_tp_doc, const_cast<char *>("The type of a type that equals array.array.")},
    {Py_tp_richcompare, reinterpret_cast<void *>(compare_types)},
    {Py_tp_hash, reinterpret_cast<void *>(hash_type)},
    {0, nullptr}};
  PyType_Spec spec = {"_rmw_manycore_arrays.type", 0, 0, Py_TPFLAGS_DEFAULT, slots};
  const Owned bases(PyTuple_Pack(1, reinterpret_cast<PyObject *>(&PyType_Type)));
  return bases ? PyType_FromSpecWithBases(&spec, bases.get()) : nullptr;
}

}  // namespace

PyTypeObject * make_record_array_type(PyTypeObject * base) {
  array_type = base;
  PyType_Slot slots[] = {
    {Py_tp_doc, const_cast<char *>("An array.array in the record that a message was taken from.")},
    {Py_tp_dealloc, reinterpret_cast<void *>(destroy)},
    {Py_tp_methods, methods()},
    {Py_sq_inplace_concat, reinterpret_cast<void *>(concatenate)},
    {Py_sq_inplace_repeat, reinterpret_cast<void *>(repeat)},
    {Py_sq_ass_item, reinterpret_cast<void *>(assign_item)},
    {Py_mp_ass_subscript, reinterpret_cast<void *>(assign)},
    {Py_bf_getbuffer, reinterpret_cast<void *>(get_buffer)},
    {Py_bf_releasebuffer, reinterpret_cast<void *>(base->tp_as_buffer->bf_releasebuffer)},
    {0, nullptr}};
  // The name is a part of what repr() returns.
  PyType_Spec spec = {
    "_rmw_manycore_arrays.array", sizeof(RecordArray), 0, Py_TPFLAGS_DEFAULT, slots};
  const Owned bases(PyTuple_Pack(1, base));
  Owned metaclass(bases ? make_metaclass() : nullptr);
  PyObject * const type = metaclass ? PyType_FromSpecWithBases(&spec, bases.get()) : nullptr;
  if (type != nullptr) {
    Py_SET_TYPE(type, reinterpret_cast<PyTypeObject *>(metaclass.release()));
  }
  return reinterpret_cast<PyTypeObject *>(type);
}

PyObject * make_record_array(
  PyTypeObject * type, PyObject * like, const RecordItems & items, Lease & lease) {
  PyObject * const self = type->tp_alloc(type, 0);
  if (self == nullptr) {
    return nullptr;
  }
  ArrayObject & array = as_array(self);
  array.items = static_cast<char *>(items.items);
  array.allocated = static_cast<Py_ssize_t>(items.count);
  array.description = as_array(like).description;
  array.exports = 1;
  Py_SET_SIZE(&array.head, static_cast<Py_ssize_t>(items.count));
  lease.keep();
  lease_of(self) = &lease;
  reinterpret_cast<RecordArray *>(self)->is_read_only = items.is_read_only;
  return self;
}

}  // namespace rmw_manycore
