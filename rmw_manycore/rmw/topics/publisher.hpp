// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rmw/context/node.hpp"
#include "rmw/events/endpoint_events.hpp"
#include "rmw/events/outbox.hpp"
#include "rmw/serialization/type_support.hpp"
#include "rmw/topics/loans.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// A publisher of rmw: its handle, serialization, events and loans.
class Publisher final : public EndpointEvents {
public:
  /// Throws manycore::Error.
  Publisher(
    const Node & node, const MessageType & type, const char * topic,
    const rmw_qos_profile_t & profile, const rmw_publisher_options_t & options);
  ~Publisher() override { clear_callbacks(); }

  static Publisher & of(const rmw_publisher_t * handle) {
    return *static_cast<Publisher *>(handle->data);
  }

  rmw_publisher_t handle{};

  const Cdr & cdr() const noexcept { return cdr_; }
  Loans & loans() const noexcept { return loans_; }
  Outbox & outbox() noexcept { return outbox_; }
  manycore::Publisher & transport() const noexcept { return outbox_.transport(); }

private:
  EventCounts counts(rmw_event_type_t type) const override;

  const std::string topic_;
  const Cdr cdr_;
  mutable Loans loans_;
  Outbox outbox_;
};

}  // namespace rmw_manycore
