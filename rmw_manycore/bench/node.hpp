// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rmw/rmw.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <std_msgs/msg/u_int8_multi_array.hpp>

/// The least of ROS 2 that a bench needs, straight over the rmw interface: no rcl, no executor.
namespace manycore::bench {

using Message = std_msgs::msg::UInt8MultiArray;

/// How long a thing may take that should take milliseconds, before a bench gives up.
constexpr std::chrono::seconds patience{60};

rmw_qos_profile_t reliable_qos(size_t depth);
/// The last message is kept for subscriptions that come later.
rmw_qos_profile_t latched_qos();

class Node {
public:
  /// Calls rmw_init; the domain is that of ROS_DOMAIN_ID.
  explicit Node(const std::string & name);
  Node(const Node &) = delete;
  Node & operator=(const Node &) = delete;
  ~Node();

  rmw_node_t * handle() const { return node_; }
  rmw_context_t * context() { return &context_; }

private:
  rmw_init_options_t options_;
  rmw_context_t context_;
  rmw_node_t * node_;
};

class Publisher {
public:
  Publisher(Node & node, const std::string & topic, const rmw_qos_profile_t & qos);
  Publisher(const Publisher &) = delete;
  Publisher & operator=(const Publisher &) = delete;
  ~Publisher();

  void publish(const Message & message);
  size_t matched() const;

private:
  Node & node_;
  rmw_publisher_t * publisher_;
};

class Subscription {
public:
  Subscription(Node & node, const std::string & topic, const rmw_qos_profile_t & qos);
  Subscription(const Subscription &) = delete;
  Subscription & operator=(const Subscription &) = delete;
  ~Subscription();

  /// Fills `message` if there was one to take.
  bool take(Message & message);
  size_t matched() const;
  void * data() const { return subscription_->data; }

private:
  Node & node_;
  rmw_subscription_t * subscription_;
};

/// Waits for one subscription and, where given, one guard condition.
class WaitSet {
public:
  explicit WaitSet(Node & node);
  WaitSet(const WaitSet &) = delete;
  WaitSet & operator=(const WaitSet &) = delete;
  ~WaitSet();

  /// Returns false after `timeout`; without one it waits for ever.
  bool wait(
    const Subscription & subscription, std::optional<std::chrono::milliseconds> timeout,
    rmw_guard_condition_t * guard_condition = nullptr);

private:
  rmw_wait_set_t * wait_set_;
};

/// Waits for and takes the next message; throws when none comes within `patience`.
void take_next(WaitSet & wait_set, Subscription & subscription, Message & message);

/// Returns when both directions of a conversation have found their other end.
void wait_until_matched(const Publisher & publisher, const Subscription & subscription);
void wait_until_matched(const Publisher & publisher, size_t subscriptions);

/// Publishes the empty message that ends subscribers, and returns when they have gone: a publisher
/// that goes first may take the message with it.
void stop_subscribers(Publisher & publisher);

/// Throws with the middleware's own words.
void check(rmw_ret_t status, const char * what);

/// Every message carries a number in its first bytes.
constexpr size_t least_message_bytes = sizeof(uint64_t);
void set_number(Message & message, uint64_t number);
uint64_t number_of(const Message & message);

}  // namespace manycore::bench
