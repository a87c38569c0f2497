// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/rcl.h>

#include <deque>
#include <string>

/// Nodes at the level of rcl, as rclcpp and rclpy make them.
namespace manycore::bench {

/// Throws with rcl's own words.
void check_rcl(rcl_ret_t status, const char * what);
/// Prints them, where nothing can be thrown.
void report_rcl(rcl_ret_t status);

class RclContext {
public:
  RclContext();
  RclContext(const RclContext &) = delete;
  RclContext & operator=(const RclContext &) = delete;
  ~RclContext();
  rcl_context_t & get() { return context_; }

private:
  rcl_context_t context_ = rcl_get_zero_initialized_context();
};

/// A node with the services of its parameters, on /rosout and /parameter_events. What it has stays
/// where it is until the node goes.
class RclNode {
public:
  RclNode(rcl_context_t & context, const std::string & name);
  RclNode(const RclNode &) = delete;
  RclNode & operator=(const RclNode &) = delete;
  ~RclNode();

  rcl_publisher_t & publish(
    const std::string & topic, const rosidl_message_type_support_t * type,
    const rmw_qos_profile_t & qos);
  rcl_subscription_t & subscribe(
    const std::string & topic, const rosidl_message_type_support_t * type,
    const rmw_qos_profile_t & qos);

  const std::deque<rcl_subscription_t> & subscriptions() const { return subscriptions_; }
  const std::deque<rcl_service_t> & services() const { return services_; }

private:
  void serve(const char * name, const rosidl_service_type_support_t * type);

  rcl_node_t node_ = rcl_get_zero_initialized_node();
  std::deque<rcl_publisher_t> publishers_;
  std::deque<rcl_subscription_t> subscriptions_;
  std::deque<rcl_service_t> services_;
};

}  // namespace manycore::bench
