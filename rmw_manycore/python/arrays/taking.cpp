// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/taking.hpp"

#include <algorithm>

#include "python/arrays/array_layout.hpp"
#include "python/arrays/lease.hpp"
#include "python/arrays/owned.hpp"
#include "python/arrays/record_array.hpp"

namespace rmw_manycore {
namespace {

size_t bytes_of(const Field & field, const BorrowedSequence & sequence) noexcept {
  return sequence.count * as_array(field.empty).description->item_bytes;
}

Owned copy(const Field & field, const BorrowedSequence & sequence) {
  Owned array(PyObject_CallMethod(field.empty, "__copy__", nullptr));
  const Owned view(PyMemoryView_FromMemory(
    reinterpret_cast<char *>(sequence.data), static_cast<Py_ssize_t>(bytes_of(field, sequence)),
    PyBUF_READ));
  if (!array || !view) {
    return {};
  }
  const Owned done(PyObject_CallMethod(array.get(), "frombytes", "O", view.get()));
  return done ? std::move(array) : Owned();
}

bool set(PyObject * object, const Field & field, const Owned & value) {
  Owned place = Owned::shared(object);
  for (size_t i = 0; place && i + 1 < field.slots.size(); ++i) {
    place = Owned(PyObject_GetAttr(place.get(), field.slots[i]));
  }
  return place && value && PyObject_SetAttr(place.get(), field.slots.back(), value.get()) == 0;
}

const Field * find(const std::vector<Field> & fields, const char * path) {
  const auto found = std::find_if(
    fields.begin(), fields.end(), [&](const Field & field) { return field.path == path; });
  if (found == fields.end()) {
    PyErr_Format(PyExc_SystemError, "the message class has no field '%s'", path);
    return nullptr;
  }
  return &*found;
}

}  // namespace

bool set_borrowed(
  const BorrowingInterface & interface, const ArrayTypes & arrays,
  const std::vector<Field> & fields, void * message, PyObject * object) {
  size_t count = 0;
  const BorrowedSequence * const sequences = interface.borrowed(message, &count);
  if (count == 0) {
    return true;
  }
  RecordHold * const hold = interface.take_hold(message);
  if (hold == nullptr) {
    PyErr_SetString(PyExc_RuntimeError, "a taken message can be converted once");
    return false;
  }
  const Access access = interface.access(hold);
  const uint8_t * const begin = sequences[0].data;
  const Field * const last = find(fields, sequences[count - 1].path);
  const uint8_t * const end =
    last == nullptr ? begin : sequences[count - 1].data + bytes_of(*last, sequences[count - 1]);
  auto & lease = *new Lease(interface, hold, begin, static_cast<size_t>(end - begin));
  bool is_set = last != nullptr;
  for (size_t i = 0; is_set && i < count; ++i) {
    const Field * const field = find(fields, sequences[i].path);
    is_set = field != nullptr &&
             set(
               object, *field,
               access == Access::copy
                 ? copy(*field, sequences[i])
                 : Owned(make_record_array(
                     arrays.in_record, field->empty,
                     {sequences[i].data, sequences[i].count, access == Access::read}, lease)));
  }
  lease.give_back();
  return is_set;
}

}  // namespace rmw_manycore
