// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/type_support.hpp"

#include <algorithm>
#include <string_view>

#include "platform/error.hpp"
#include "rcutils/error_handling.h"
#include "rmw/serialization/known_lengths.hpp"
#include "rosidl_typesupport_fastrtps_c/identifier.h"
#include "rosidl_typesupport_fastrtps_cpp/identifier.hpp"
#include "rosidl_typesupport_fastrtps_cpp/service_type_support.h"

namespace rmw_manycore {
namespace {

/// Finds the C type support, or else the C++ one, with rosidl's `find_handle`.
template<typename TypeSupport>
const TypeSupport * find(
  const TypeSupport * type_support,
  const TypeSupport * (*find_handle)(const TypeSupport *, const char *)) {
  std::string reasons;
  for (const char * const wanted :
       {rosidl_typesupport_fastrtps_c__identifier,
        rosidl_typesupport_fastrtps_cpp::typesupport_identifier}) {
    if (const TypeSupport * const found = find_handle(type_support, wanted)) {
      return found;
    }
    reasons += std::string("\n    ") + rcutils_get_error_string().str;
    rcutils_reset_error();
  }
  throw manycore::Error(
    manycore::ErrorCode::invalid_argument,
    "the type has no type support for Fast CDR (rosidl_typesupport_fastrtps_c or _cpp):" + reasons);
}

void replace_all(std::string & text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Converts "std_msgs::msg" (C++) or "std_msgs__msg" (C) and "String" to "std_msgs/msg/String".
std::string ros_name(const char * ns, const char * name) {
  std::string result = ns;
  replace_all(result, "::", "/");
  replace_all(result, "__", "/");
  return result.empty() ? name : result + "/" + name;
}

template<typename TypeSupport>
manycore::TypeHash hash_of(const TypeSupport * type_support) {
  manycore::TypeHash hash;
  if (type_support->get_type_hash_func != nullptr) {
    if (const rosidl_type_hash_t * const found = type_support->get_type_hash_func(type_support)) {
      hash.version = found->version;
      std::copy(std::begin(found->value), std::end(found->value), hash.value.begin());
    }
  }
  return hash;
}

const message_type_support_callbacks_t & callbacks_of(const rosidl_message_type_support_t * found) {
  return *static_cast<const message_type_support_callbacks_t *>(found->data);
}

}  // namespace

MessageType MessageType::of(const rosidl_message_type_support_t * type_support) {
  const auto & callbacks = callbacks_of(find(type_support, get_message_typesupport_handle));
  return {
    ros_name(callbacks.message_namespace_, callbacks.message_name_), hash_of(type_support),
    cdr_of(type_support)};
}

ServiceType ServiceType::of(const rosidl_service_type_support_t * type_support) {
  const auto & callbacks = *static_cast<const service_type_support_callbacks_t *>(
    find(type_support, get_service_typesupport_handle)->data);
  const auto cdr = [type_support](
                     const rosidl_message_type_support_t * members, CdrLengths::Part part) {
    return Cdr(callbacks_of(members), std::make_shared<CdrLengths>(*type_support, part));
  };
  return {
    ros_name(callbacks.service_namespace_, callbacks.service_name_), hash_of(type_support),
    cdr(callbacks.request_members_, CdrLengths::Part::request),
    cdr(callbacks.response_members_, CdrLengths::Part::response)};
}

Cdr cdr_of(const rosidl_message_type_support_t * type_support) {
  const auto & callbacks = callbacks_of(find(type_support, get_message_typesupport_handle));
  return Cdr(callbacks, lengths_of(*type_support, callbacks));
}

}  // namespace rmw_manycore
