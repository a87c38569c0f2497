// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>

#include "rmw/context/node.hpp"
#include "rmw/events/inbox.hpp"
#include "rmw/events/outbox.hpp"
#include "rmw/serialization/type_support.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// A service client: sends requests, receives replies. Its reply subscription exists before the
/// first request is sent and until after the last one.
class Client {
public:
  /// Throws manycore::Error.
  Client(const Node & node, ServiceType type, const char * name, const rmw_qos_profile_t & profile);
  Client(const Client &) = delete;
  Client & operator=(const Client &) = delete;

  static Client & of(const rmw_client_t * handle) { return *static_cast<Client *>(handle->data); }

  rmw_client_t handle{};

  const ServiceType & type() const noexcept { return type_; }
  Outbox & requests() noexcept { return requests_; }
  Inbox & replies() noexcept { return replies_; }

  /// Identifies the client in requests and replies.
  const manycore::Gid & gid() const noexcept { return replies_.transport().gid(); }
  manycore::Correlation next_request() noexcept { return {gid(), ++last_number_}; }

private:
  const std::string name_;
  const ServiceType type_;
  Inbox replies_;
  Outbox requests_;
  std::atomic<int64_t> last_number_{0};
};

}  // namespace rmw_manycore
