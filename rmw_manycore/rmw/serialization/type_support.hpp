// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rmw/serialization/cdr.hpp"
#include "rosidl_runtime_c/message_type_support_struct.h"
#include "rosidl_runtime_c/service_type_support_struct.h"
#include "transport/layout/endpoint.hpp"

namespace rmw_manycore {

/// A message type: name, type hash and CDR serialization.
struct MessageType {
  std::string name;  ///< "std_msgs/msg/String"
  manycore::TypeHash hash;
  Cdr cdr;

  /// Throws manycore::Error{invalid_argument} if there is no type support for Fast CDR (C or C++).
  static MessageType of(const rosidl_message_type_support_t * type_support);
};

/// A service type; name and hash belong to the service.
struct ServiceType {
  std::string name;  ///< "std_srvs/srv/SetBool"
  manycore::TypeHash hash;
  Cdr request;
  Cdr response;

  /// Throws as MessageType::of().
  static ServiceType of(const rosidl_service_type_support_t * type_support);
};

/// CDR serialization of a message type. Throws as MessageType::of().
Cdr cdr_of(const rosidl_message_type_support_t * type_support);

}  // namespace rmw_manycore
