// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "rosidl_runtime_c/message_type_support_struct.h"
#include "rosidl_typesupport_introspection_c/message_introspection.h"

/// How messages of one type look to C, or to C++: a node in Python uses the first, one in C++ the
/// second.
class MessageType {
public:
  enum class Language { c, cpp };

  /// `name` as in "std_msgs/msg/String"; throws std::runtime_error without its library.
  MessageType(const std::string & name, Language language);

  const std::string & name() const noexcept { return name_; }
  const rosidl_message_type_support_t * support() const noexcept { return support_; }

  /// A message with the values that a new one has.
  std::shared_ptr<void> create() const;

private:
  std::string name_;
  const rosidl_message_type_support_t * support_;
  const void * members_;
  Language language_;
};

using Members = rosidl_typesupport_introspection_c__MessageMembers;
using Member = rosidl_typesupport_introspection_c__MessageMember;

/// The fields of a type.
const Members & members_of(const std::string & name);
