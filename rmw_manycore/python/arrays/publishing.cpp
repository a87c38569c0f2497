// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/publishing.hpp"

#include <unordered_map>
#include <utility>

#include "python/arrays/array_layout.hpp"
#include "python/arrays/message_type.hpp"
#include "python/arrays/owned.hpp"

namespace rmw_manycore {
namespace {

/// A large array of a Python message.
struct Large {
  const Field * field;
  Py_buffer view;
};

/// Given back by take_back(), or at the end of a failed conversion.
class Buffers {
public:
  Buffers() = default;
  Buffers(Buffers &&) = default;
  Buffers & operator=(Buffers &&) = default;
  ~Buffers() {
    for (Large & large : all) {
      PyBuffer_Release(&large.view);
    }
  }

  std::vector<Large> all;
};

std::unordered_map<const void *, Buffers> & lent() {
  static auto & lent = *new std::unordered_map<const void *, Buffers>;  // Python ends after it
  return lent;
}

/// The value of a field if all messages on the way are of the generated classes, whose attributes
/// do no more than return it.
Owned value_of(PyObject * object, const Field & field) {
  Owned place = Owned::shared(object);
  for (size_t i = 0; i < field.slots.size(); ++i) {
    if (i != 0 && Py_TYPE(place.get()) != field.classes[i - 1]) {
      return {};
    }
    place = Owned(PyObject_GetAttr(place.get(), field.slots[i]));
    if (!place) {
      PyErr_Clear();  // upstream's converter raises it
      return {};
    }
  }
  return place;
}

bool is_large(const ArrayTypes & arrays, PyObject * value, const Field & field) noexcept {
  if (!arrays.have(value)) {
    return false;
  }
  const ArrayDescription & description = *as_array(value).description;
  return description.typecode == field.typecode() &&
         static_cast<size_t>(Py_SIZE(value)) * description.item_bytes >= min_borrowed_bytes;
}

bool find_offset(const MessageType & type, Field & field) noexcept {
  if (field.offset == Field::unknown) {
    field.offset =
      type.interface.offset_of(type.type_support, field.path.c_str(), field.typecode());
  }
  return field.offset != Field::none;
}

Buffers large_arrays(MessageType & type, PyObject * object) {
  Buffers found;
  for (Field & field : type.fields) {
    const Owned value = value_of(object, field);
    if (value && is_large(type.arrays, value.get(), field) && find_offset(type, field)) {
      found.all.reserve(found.all.size() + 1);
      Py_buffer view;
      if (PyObject_GetBuffer(value.get(), &view, PyBUF_SIMPLE) == 0) {
        found.all.push_back({&field, view});
      }
      PyErr_Clear();
    }
  }
  return found;
}

/// A message of the same class with the same values.
Owned shallow_copy(PyObject * object) {
  auto * const type = reinterpret_cast<PyObject *>(Py_TYPE(object));
  const Owned slots(PyObject_GetAttrString(type, "__slots__"));
  const Owned names(slots ? PySequence_Fast(slots.get(), "no slots") : nullptr);
  Owned copy(names ? PyObject_CallMethod(type, "__new__", "O", type) : nullptr);
  for (Py_ssize_t i = 0; copy && i < PySequence_Fast_GET_SIZE(names.get()); ++i) {
    PyObject * const name = PySequence_Fast_GET_ITEM(names.get(), i);
    const Owned value(PyObject_GetAttr(object, name));
    if (!value || PyObject_SetAttr(copy.get(), name, value.get()) != 0) {
      return {};
    }
  }
  return copy;
}

/// Replaces an array in `copy` by an empty one, and nested messages on the way by copies.
bool empty(PyObject * object, const Owned & copy, const Field & field) {
  Owned from = Owned::shared(object);
  Owned to = Owned::shared(copy.get());
  for (size_t i = 0; i + 1 < field.slots.size(); ++i) {
    Owned nested(PyObject_GetAttr(from.get(), field.slots[i]));
    Owned copied(PyObject_GetAttr(to.get(), field.slots[i]));
    if (nested && nested.get() == copied.get()) {
      copied = shallow_copy(nested.get());
      if (!copied || PyObject_SetAttr(to.get(), field.slots[i], copied.get()) != 0) {
        return false;
      }
    }
    if (!nested || !copied) {
      return false;
    }
    from = std::move(nested);
    to = std::move(copied);
  }
  return PyObject_SetAttr(to.get(), field.slots.back(), field.empty) == 0;
}

Owned without(PyObject * object, const Buffers & buffers) {
  Owned copy = shallow_copy(object);
  for (const Large & large : buffers.all) {
    if (!copy || !empty(object, copy, *large.field)) {
      return {};
    }
  }
  return copy;
}

}  // namespace

bool Lending::convert(MessageType & type, PyObject * object, void * message) {
  Buffers buffers;
  if (Py_TYPE(object) == type.message_class) {
    buffers = large_arrays(type, object);
  }
  if (buffers.all.empty()) {
    return type.upstream.from_python(object, message);
  }
  const Owned small = without(object, buffers);
  if (!small) {
    PyErr_Clear();
    return type.upstream.from_python(object, message);
  }
  Buffers & kept = lent()[message];
  if (!type.upstream.from_python(small.get(), message)) {
    lent().erase(message);
    return false;
  }
  for (const Large & large : buffers.all) {
    const size_t count =
      static_cast<size_t>(large.view.len) / as_array(large.field->empty).description->item_bytes;
    const Field & field = *large.field;
    type.interface.lend(message, field.offset, field.typecode(), large.view.buf, count);
  }
  kept = std::move(buffers);
  return true;
}

void Lending::take_back(const MessageType & type, void * message) noexcept {
  const auto found = lent().find(message);
  if (found == lent().end()) {
    return;
  }
  for (const Large & large : found->second.all) {
    type.interface.lend(message, large.field->offset, large.field->typecode(), nullptr, 0);
  }
  lent().erase(found);
}

}  // namespace rmw_manycore
