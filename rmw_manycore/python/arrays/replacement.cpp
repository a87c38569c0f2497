// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/replacement.hpp"

#include <dlfcn.h>

#include <array>
#include <utility>

#include "python/arrays/message_type.hpp"
#include "python/arrays/owned.hpp"

namespace rmw_manycore {
namespace {

/// Converters get no context, so each type has functions of its own. The wheels of ROS 2 have about
/// a hundred types with sequences of numbers.
constexpr size_t max_types = 256;
size_t type_count = 0;
std::array<MessageType *, max_types> types;

template<size_t index>
Converters converters_of_type() {
  return {
    [] { return types[index]->create(); }, [](void * message) { types[index]->destroy(message); },
    [](PyObject * object, void * message) { return types[index]->from_python(object, message); },
    [](void * message) { return types[index]->to_python(message); }};
}

template<size_t... indices>
std::array<Converters, max_types> all_converters(std::index_sequence<indices...>) {
  return {converters_of_type<indices>()...};
}

/// Null until a process has loaded the middleware.
const BorrowingInterface * find_interface() {
  static const BorrowingInterface * found = nullptr;
  if (found == nullptr) {
    if (void * const library = dlopen("librmw_manycore.so", RTLD_LAZY | RTLD_NOLOAD)) {
      const auto function = reinterpret_cast<BorrowingFunction>(dlsym(library, borrowing_function));
      found = function == nullptr ? nullptr : function();
    }
  }
  return found;
}

class Capsule {
public:
  Capsule(PyObject * metaclass, const char * name)
  : metaclass_(metaclass), name_(name), capsule_(PyObject_GetAttrString(metaclass, name)) {}

  /// Null, with an exception, on failure.
  void * pointer() const {
    return capsule_ ? PyCapsule_GetPointer(capsule_.get(), PyCapsule_GetName(capsule_.get()))
                    : nullptr;
  }
  template<typename Function>
  bool read(Function & function) const {
    function = reinterpret_cast<Function>(pointer());
    return function != nullptr;
  }
  template<typename Function>
  bool replace(Function function) const {
    const Owned made(PyCapsule_New(
      reinterpret_cast<void *>(function), PyCapsule_GetName(capsule_.get()), nullptr));
    return made && PyObject_SetAttrString(metaclass_, name_, made.get()) == 0;
  }

private:
  PyObject * metaclass_;
  const char * name_;
  Owned capsule_;
};

}  // namespace

bool replace_converters(
  PyTypeObject * message_class, PyObject * described, const ArrayTypes & arrays,
  bool is_read_only) {
  const BorrowingInterface * const interface = find_interface();
  if (interface == nullptr || type_count == max_types) {
    return true;
  }
  auto * const metaclass = reinterpret_cast<PyObject *>(Py_TYPE(message_class));
  const Capsule create(metaclass, "_CREATE_ROS_MESSAGE");
  const Capsule destroy(metaclass, "_DESTROY_ROS_MESSAGE");
  const Capsule from_python(metaclass, "_CONVERT_FROM_PY");
  const Capsule to_python(metaclass, "_CONVERT_TO_PY");
  const void * const type_support = Capsule(metaclass, "_TYPE_SUPPORT").pointer();
  Converters upstream{};
  std::vector<Field> fields;
  if (
    type_support == nullptr || !create.read(upstream.create) || !destroy.read(upstream.destroy) ||
    !from_python.read(upstream.from_python) || !to_python.read(upstream.to_python) ||
    !read_fields(described, arrays.plain, fields)) {
    return false;
  }
  static const auto all = all_converters(std::make_index_sequence<max_types>());
  const Converters & ours = all[type_count];
  types[type_count++] = new MessageType{*interface,        upstream, message_class, type_support,
                                        std::move(fields), arrays,   is_read_only};
  Py_INCREF(message_class);
  return create.replace(ours.create) && destroy.replace(ours.destroy) &&
         from_python.replace(ours.from_python) && to_python.replace(ours.to_python);
}

}  // namespace rmw_manycore
