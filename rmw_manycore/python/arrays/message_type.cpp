// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/message_type.hpp"

#include <exception>

#include "python/arrays/owned.hpp"

namespace rmw_manycore {

void * MessageType::create() const noexcept {
  void * const message = upstream.create();
  if (message != nullptr) {
    interface.adopt(message, is_read_only);  // else it is taken by copies
  }
  return message;
}

void MessageType::destroy(void * message) const noexcept {
  const PyGILState_STATE state = PyGILState_Ensure();
  Lending::take_back(*this, message);
  PyGILState_Release(state);
  interface.forget(message);
  upstream.destroy(message);
}

bool MessageType::from_python(PyObject * object, void * message) noexcept {
  try {
    return Lending::convert(*this, object, message);
  } catch (const std::exception &) {
    PyErr_NoMemory();
    return false;
  }
}

PyObject * MessageType::to_python(void * message) const noexcept {
  try {
    Owned object(upstream.to_python(message));
    const bool is_whole = object && set_borrowed(interface, arrays, fields, message, object.get());
    return is_whole ? object.release() : nullptr;
  } catch (const std::exception &) {
    return PyErr_NoMemory();
  }
}

}  // namespace rmw_manycore
