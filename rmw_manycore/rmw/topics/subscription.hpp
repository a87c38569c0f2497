// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "rmw/context/node.hpp"
#include "rmw/events/endpoint_events.hpp"
#include "rmw/events/inbox.hpp"
#include "rmw/serialization/type_support.hpp"
#include "rmw/topics/loans.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// A subscription of rmw: its handle, serialization, events, loans and inbox.
class Subscription final : public EndpointEvents {
public:
  /// Throws manycore::Error.
  Subscription(
    const Node & node, const MessageType & type, const char * topic,
    const rmw_qos_profile_t & profile, const rmw_subscription_options_t & options);
  ~Subscription() override { clear_callbacks(); }

  static Subscription & of(const rmw_subscription_t * handle) {
    return *static_cast<Subscription *>(handle->data);
  }

  rmw_subscription_t handle{};
  std::atomic<bool> has_warned_of_copies{false};

  const Cdr & cdr() const noexcept { return cdr_; }
  Loans & loans() noexcept { return loans_; }
  Inbox & inbox() noexcept { return inbox_; }
  const std::shared_ptr<manycore::Process> & process() const noexcept { return process_; }
  const manycore::Subscription & transport() const noexcept { return inbox_.transport(); }

private:
  EventCounts counts(rmw_event_type_t type) const override;

  const std::shared_ptr<manycore::Process> process_;
  const std::string topic_;
  const Cdr cdr_;
  Loans loans_;
  Inbox inbox_;
  mutable LivelinessChanges liveliness_changes_;
};

}  // namespace rmw_manycore
