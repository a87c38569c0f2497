// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "rosidl_runtime_c/message_type_support_struct.h"
#include "rosidl_typesupport_introspection_c/message_introspection.h"

/// Representation of one message type in C, used by Python nodes, or in C++.
class MessageType {
public:
  enum class Language { c, cpp };

  /// `name` is like "std_msgs/msg/String", or "std_srvs/srv/SetBool_Request". Throws
  /// std::runtime_error if its library is missing.
  MessageType(const std::string & name, Language language);

  const std::string & name() const noexcept { return name_; }
  const rosidl_message_type_support_t * support() const noexcept { return support_; }

  /// Creates a message with default values.
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
