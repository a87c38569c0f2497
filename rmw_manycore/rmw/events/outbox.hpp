// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "rmw/events/callback_thread.hpp"
#include "transport/publisher/publisher.hpp"

namespace rmw_manycore {

/// Sending side of a publisher, service or client. Calls the callbacks for arrivals of its context
/// itself, so that a message between nodes of one process wakes no thread.
class Outbox {
public:
  Outbox(
    std::unique_ptr<manycore::Publisher> publisher, MessageTopic topic, CallbackThread & thread)
  : publisher_(std::move(publisher)), topic_(std::move(topic)), thread_(thread) {}

  manycore::Publisher & transport() const noexcept { return *publisher_; }
  uint32_t slot() const noexcept { return publisher_->slot(); }

  /// As manycore::Publisher.
  manycore::Draft draft(size_t size_bytes) { return publisher_->draft(size_bytes); }
  void publish(
    manycore::Draft && draft, size_t size_bytes, int64_t source_timestamp_ns,
    const manycore::Correlation & correlation = {});

private:
  const std::unique_ptr<manycore::Publisher> publisher_;
  const MessageTopic topic_;
  CallbackThread & thread_;
};

}  // namespace rmw_manycore
