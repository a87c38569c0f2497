// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "message_type.hpp"
#include "rmw/rmw.h"

/// Throws std::runtime_error with the middleware's error text unless `code` is RMW_RET_OK.
void check(rmw_ret_t code, const char * what);

/// A node on a platform of its own.
class Node {
public:
  Node();
  ~Node();
  Node(const Node &) = delete;
  Node & operator=(const Node &) = delete;

  rmw_node_t * handle() const noexcept { return node_; }

private:
  rmw_init_options_t options_;
  rmw_context_t context_;
  rmw_node_t * node_;
};

/// A publisher and a subscription of one topic.
class Topic {
public:
  Topic(const Node & node, const std::string & name, const MessageType & type);
  ~Topic();
  Topic(const Topic &) = delete;
  Topic & operator=(const Topic &) = delete;

  /// Publishes the bytes unchanged.
  void publish(const std::vector<uint8_t> & cdr);
  /// Takes a message; false if there is none. Throws if the take fails.
  bool take(void * message);
  /// Total of the message-lost event.
  uint64_t lost();

private:
  const Node & node_;
  rmw_publisher_t * publisher_;
  rmw_subscription_t * subscription_;
  rmw_event_t lost_event_;
};
