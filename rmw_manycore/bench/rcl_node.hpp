// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/rcl.h>

#include <deque>
#include <string>
#include <vector>

/// Nodes at the rcl level, with the entities that rclcpp and rclpy create.
namespace manycore::bench {

/// Throws with rcl's error text unless `status` is RCL_RET_OK.
void check_rcl(rcl_ret_t status, const char * what);
/// Prints rcl's error text, for destructors.
void report_rcl(rcl_ret_t status);
/// Takes a message of /parameter_events, if there is one, and drops it.
void take_parameter_event(const rcl_subscription_t & subscription);

/// An rcl context, shut down by the destructor.
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

/// Ends a wait when triggered, from any thread.
class RclGuardCondition {
public:
  explicit RclGuardCondition(RclContext & context);
  RclGuardCondition(const RclGuardCondition &) = delete;
  RclGuardCondition & operator=(const RclGuardCondition &) = delete;
  ~RclGuardCondition() { report_rcl(rcl_guard_condition_fini(&condition_)); }

  void trigger() { report_rcl(rcl_trigger_guard_condition(&condition_)); }
  const rcl_guard_condition_t & get() const { return condition_; }

private:
  rcl_guard_condition_t condition_ = rcl_get_zero_initialized_guard_condition();
};

/// A node with parameter services, /rosout and /parameter_events. Its entities keep their addresses
/// for its lifetime.
class RclNode {
public:
  /// `name` may be full, such as "/sensing/lidar".
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

  rcl_client_t & call(const char * service, const rosidl_service_type_support_t * type);

  rcl_node_t & get() { return node_; }
  const std::deque<rcl_subscription_t> & subscriptions() const { return subscriptions_; }
  const std::deque<rcl_client_t> & clients() const { return clients_; }
  const std::deque<rcl_service_t> & services() const { return services_; }

private:
  void serve(const char * name, const rosidl_service_type_support_t * type);

  rcl_node_t node_ = rcl_get_zero_initialized_node();
  std::deque<rcl_publisher_t> publishers_;
  std::deque<rcl_subscription_t> subscriptions_;
  std::deque<rcl_client_t> clients_;
  std::deque<rcl_service_t> services_;
};

/// Waits for all entities of some nodes, as the executors of rclcpp and rclpy do.
class RclWaitSet {
public:
  /// `end` ends a wait; so does `timer`, unless it is nullptr. The nodes' entities must not change.
  RclWaitSet(
    rcl_context_t & context, std::vector<const RclNode *> nodes, const RclGuardCondition & end,
    rcl_timer_t * timer = nullptr);
  RclWaitSet(const RclWaitSet &) = delete;
  RclWaitSet & operator=(const RclWaitSet &) = delete;
  ~RclWaitSet() { report_rcl(rcl_wait_set_fini(&wait_set_)); }

  /// Waits until any entity is ready, or for `timeout_ns` if that is not negative.
  void wait(int64_t timeout_ns = -1);

  bool is_ended() const { return wait_set_.guard_conditions[0] != nullptr; }
  bool is_timer_ready() const { return timer_ != nullptr && wait_set_.timers[0] != nullptr; }
  bool has_request() const;
  bool is_ready(const rcl_subscription_t & subscription) const;
  template<typename Visit>
  void for_each_ready_subscription(Visit visit) const {
    for (size_t i = 0; i < wait_set_.size_of_subscriptions; ++i) {
      if (wait_set_.subscriptions[i] != nullptr) {
        visit(*wait_set_.subscriptions[i]);
      }
    }
  }

private:
  void add_all();

  const std::vector<const RclNode *> nodes_;
  const RclGuardCondition & end_;
  rcl_timer_t * const timer_;
  rcl_wait_set_t wait_set_ = rcl_get_zero_initialized_wait_set();
};

}  // namespace manycore::bench
