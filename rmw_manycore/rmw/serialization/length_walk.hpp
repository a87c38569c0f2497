// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rosidl_typesupport_introspection_c/field_types.h"

namespace rmw_manycore {

/// How many bytes a value of a primitive type takes; 0 for other types.
constexpr size_t primitive_bytes(uint8_t type_id) noexcept {
  switch (type_id) {
    case rosidl_typesupport_introspection_c__ROS_TYPE_CHAR:
    case rosidl_typesupport_introspection_c__ROS_TYPE_BOOLEAN:
    case rosidl_typesupport_introspection_c__ROS_TYPE_OCTET:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT8:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT8:
      return 1;
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT16:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT16:
      return 2;
    case rosidl_typesupport_introspection_c__ROS_TYPE_FLOAT:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT32:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT32:
      return 4;
    case rosidl_typesupport_introspection_c__ROS_TYPE_DOUBLE:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT64:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT64:
      return 8;
    default:
      return 0;
  }
}

/// `Member` of C and of C++ introspection have the same fields; so have the types of messages.
template<typename Member>
constexpr bool is_sequence(const Member & member) noexcept {
  return member.is_array_ && (member.array_size_ == 0 || member.is_upper_bound_);
}

template<typename Members, typename Member>
const Members & members_of(const Member & member) noexcept {
  return *static_cast<const Members *>(member.members_->data);
}

/// Follows the CDR of one message along its type, to see whether the lengths in it can be true.
/// Only reads: of the bytes given, and of the type's description.
template<typename Members>
class LengthWalk {
public:
  /// `data` starts behind the encapsulation header; `widest` is the largest alignment.
  LengthWalk(const uint8_t * data, size_t size, bool swapped, size_t widest) noexcept
  : data_(data), size_(size), swapped_(swapped), widest_(widest) {}

  bool fits(const Members & type) noexcept { return message(type) || is_unknown_; }

  /// Types without sequences and wide strings need no walk.
  static bool has_lengths(const Members & type) noexcept {
    return any_member(type, [](const auto & member) {
      return is_sequence(member) || is_wide_string(member) ||
             (is_message(member) && has_lengths(sub(member)));
    });
  }

private:
  template<typename Member>
  static bool is_message(const Member & member) noexcept {
    return member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_MESSAGE;
  }
  template<typename Member>
  static bool is_wide_string(const Member & member) noexcept {
    return member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_WSTRING;
  }
  template<typename Member>
  static bool is_string(const Member & member) noexcept {
    return member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_STRING;
  }
  template<typename Member>
  static const Members & sub(const Member & member) noexcept {
    return members_of<Members>(member);
  }
  template<typename Predicate>
  static bool any_member(const Members & type, Predicate && predicate) noexcept {
    return std::any_of(type.members_, type.members_ + type.member_count_, predicate);
  }

  /// The least that one element takes; strings and sequences at least their length.
  template<typename Member>
  static size_t least_bytes_of_element(const Member & member) noexcept {
    if (is_message(member)) {
      return std::max(least_bytes(sub(member)), size_t{1});
    }
    const size_t bytes = primitive_bytes(member.type_id_);
    return bytes != 0 ? bytes : size_t{length_bytes};
  }
  static size_t least_bytes(const Members & type) noexcept {
    size_t sum = 0;
    for (uint32_t i = 0; i < type.member_count_; ++i) {
      const auto & member = type.members_[i];
      const size_t count = member.is_array_ ? member.array_size_ : 1;
      sum += is_sequence(member) ? length_bytes : count * least_bytes_of_element(member);
    }
    return sum;
  }
  /// Size of the primitives in a message that has no others, so that it has no padding; else 0.
  static size_t uniform_bytes(const Members & type) noexcept {
    size_t common = 0;
    const bool differs = any_member(type, [&common](const auto & member) {
      const size_t bytes =
        is_message(member) ? uniform_bytes(sub(member)) : primitive_bytes(member.type_id_);
      common = common == 0 ? bytes : common;
      return is_sequence(member) || bytes == 0 || bytes != common;
    });
    return differs ? 0 : common;
  }

  size_t left() const noexcept { return size_ - at_; }
  bool skip(size_t bytes) noexcept {
    if (bytes > left()) {
      return false;
    }
    at_ += bytes;
    return true;
  }
  bool align(size_t bytes) noexcept {
    const size_t alignment = std::min(bytes, widest_);
    return skip((alignment - at_ % alignment) % alignment);
  }
  bool length(size_t & result) noexcept {
    if (!align(length_bytes) || left() < length_bytes) {
      return false;
    }
    uint32_t value = 0;
    std::memcpy(&value, data_ + at_, length_bytes);
    result = swapped_ ? __builtin_bswap32(value) : value;
    return skip(length_bytes);
  }

  bool message(const Members & type) noexcept {
    return !any_member(type, [this](const auto & member) {
      size_t count = member.is_array_ ? member.array_size_ : 1;
      const bool there =
        !is_sequence(member) || (length(count) && count <= left() / least_bytes_of_element(member));
      return !there || !elements(member, count);
    });
  }
  template<typename Member>
  bool elements(const Member & member, size_t count) noexcept {
    if (count == 0) {
      return true;
    }
    if (const size_t bytes = primitive_bytes(member.type_id_)) {
      return align(bytes) && skip(bytes * count);
    }
    if (is_message(member)) {
      return messages(sub(member), count);
    }
    if (is_string(member) || is_wide_string(member)) {
      return strings(is_wide_string(member) ? wide_character_bytes : 1, count);
    }
    is_unknown_ = true;
    return false;
  }
  bool messages(const Members & type, size_t count) noexcept {
    if (const size_t bytes = uniform_bytes(type)) {
      return align(bytes) && skip(least_bytes(type) * count);
    }
    while (count != 0 && message(type)) {
      --count;
    }
    return count == 0;
  }
  bool strings(size_t character_bytes, size_t count) noexcept {
    for (size_t characters = 0; count != 0; --count) {
      if (!length(characters) || !skip(characters * character_bytes)) {
        return false;
      }
    }
    return true;
  }

  static constexpr size_t length_bytes = 4;
  static constexpr size_t wide_character_bytes = 4;

  const uint8_t * data_;
  size_t size_;
  size_t at_ = 0;
  bool swapped_;
  size_t widest_;
  bool is_unknown_ = false;  ///< met a type whose CDR is not defined (long double, wide character)
};

}  // namespace rmw_manycore
