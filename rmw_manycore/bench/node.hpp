// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rmw/rmw.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <std_msgs/msg/u_int8_multi_array.hpp>

/// Minimal ROS 2 for benches, directly over the rmw interface: no rcl, no executor.
namespace manycore::bench {

using Message = std_msgs::msg::UInt8MultiArray;

/// Timeout of operations that should take milliseconds.
constexpr std::chrono::seconds timeout{60};

rmw_qos_profile_t reliable_qos(size_t depth);
/// Keeps the last message for late subscriptions.
rmw_qos_profile_t latched_qos();

/// A node in its own context.
class Node {
public:
  /// Calls rmw_init in the domain ROS_DOMAIN_ID.
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

/// A publisher of Message.
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

/// A subscription to Message.
class Subscription {
public:
  Subscription(Node & node, const std::string & topic, const rmw_qos_profile_t & qos);
  Subscription(const Subscription &) = delete;
  Subscription & operator=(const Subscription &) = delete;
  ~Subscription();

  /// Fills `message` and returns true if there was a message.
  bool take(Message & message);
  size_t matched() const;
  void * data() const { return subscription_->data; }

private:
  Node & node_;
  rmw_subscription_t * subscription_;
};

/// Waits for one subscription and an optional guard condition.
class WaitSet {
public:
  explicit WaitSet(Node & node);
  WaitSet(const WaitSet &) = delete;
  WaitSet & operator=(const WaitSet &) = delete;
  ~WaitSet();

  /// Returns false after `timeout`; waits forever without one.
  bool wait(
    const Subscription & subscription, std::optional<std::chrono::milliseconds> timeout,
    rmw_guard_condition_t * guard_condition = nullptr);

private:
  rmw_wait_set_t * wait_set_;
};

/// Waits for the next message and takes it. Throws if none arrives within `timeout`.
void take_next(WaitSet & wait_set, Subscription & subscription, Message & message);

/// Returns when both directions of a conversation are matched.
void wait_until_matched(const Publisher & publisher, const Subscription & subscription);
void wait_until_matched(const Publisher & publisher, size_t subscriptions);

/// Publishes the empty message that ends subscribers, and returns when they are gone: a publisher
/// that ends earlier may take the message with it.
void stop_subscribers(Publisher & publisher);

/// Throws with the middleware's error text unless `status` is RMW_RET_OK.
void check(rmw_ret_t status, const char * what);

/// Each message starts with a number.
constexpr size_t min_message_bytes = sizeof(uint64_t);
void set_number(Message & message, uint64_t number);
uint64_t number_of(const Message & message);

}  // namespace manycore::bench
