// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "transport/layout/endpoint.hpp"

namespace rmw_manycore {

/// What Outboxes and Inboxes that exchange messages have in common: messages of a topic, requests
/// to a service, or replies of one.
class MessageTopic {
public:
  MessageTopic(manycore::EndpointRole role, std::string name)
  : role_(role),
    name_(std::move(name)),
    hash_(std::hash<std::string>()(name_) + static_cast<size_t>(role_)) {}

  size_t hash() const noexcept { return hash_; }
  bool operator==(const MessageTopic & other) const noexcept {
    return hash_ == other.hash_ && role_ == other.role_ && name_ == other.name_;
  }

private:
  const manycore::EndpointRole role_;
  const std::string name_;
  const size_t hash_;
};

}  // namespace rmw_manycore
