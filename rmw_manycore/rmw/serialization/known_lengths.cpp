// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/known_lengths.hpp"

#include <string>
#include <unordered_map>

namespace rmw_manycore {
namespace {

/// The address alone does not identify a type: its library may be unloaded and another one loaded
/// at the same address.
struct Known {
  const rosidl_message_type_support_t * type;
  std::string ns;
  std::string name;
  std::shared_ptr<const CdrLengths> lengths;

  bool is_of(
    const rosidl_message_type_support_t & other,
    const message_type_support_callbacks_t & callbacks) const {
    return type == &other && ns == callbacks.message_namespace_ && name == callbacks.message_name_;
  }
};

struct KnownTypes {
  std::mutex mutex;
  std::unordered_map<const message_type_support_callbacks_t *, Known> by_callbacks;
};

}  // namespace

std::shared_ptr<const CdrLengths> lengths_of(
  const rosidl_message_type_support_t & type, const message_type_support_callbacks_t & callbacks) {
  static KnownTypes & types = *new KnownTypes;  // never destroyed: threads may still use it at exit
  const std::lock_guard<std::mutex> lock(types.mutex);
  Known & known = types.by_callbacks[&callbacks];
  if (known.lengths == nullptr || !known.is_of(type, callbacks)) {
    known = {
      &type, callbacks.message_namespace_, callbacks.message_name_,
      std::make_shared<const CdrLengths>(type)};
  }
  return known.lengths;
}

}  // namespace rmw_manycore
