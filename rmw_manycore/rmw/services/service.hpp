// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rmw/context/node.hpp"
#include "rmw/events/inbox.hpp"
#include "rmw/events/outbox.hpp"
#include "rmw/serialization/type_support.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// A service server: receives requests, sends replies. Its reply publisher exists before the first
/// request can arrive and until after the last one.
class Service {
public:
  /// Throws manycore::Error.
  Service(
    const Node & node, ServiceType type, const char * name, const rmw_qos_profile_t & profile);
  Service(const Service &) = delete;
  Service & operator=(const Service &) = delete;

  static Service & of(const rmw_service_t * handle) {
    return *static_cast<Service *>(handle->data);
  }

  rmw_service_t handle{};

  const ServiceType & type() const noexcept { return type_; }
  Outbox & replies() noexcept { return replies_; }
  Inbox & requests() noexcept { return requests_; }

private:
  const std::string name_;
  const ServiceType type_;
  Outbox replies_;
  Inbox requests_;
};

}  // namespace rmw_manycore
