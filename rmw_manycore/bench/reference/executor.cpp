// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/executor.hpp"

#include <rcl/timer.h>

#include <chrono>
#include <optional>
#include <stdexcept>

namespace manycore::bench::reference {

namespace {

class Timer {
public:
  Timer(RclContext & context, std::chrono::nanoseconds period) {
    rcl_allocator_t allocator = rcl_get_default_allocator();
    check_rcl(rcl_clock_init(RCL_STEADY_TIME, &clock_, &allocator), "rcl_clock_init");
    check_rcl(
      rcl_timer_init2(&timer_, &clock_, &context.get(), period.count(), nullptr, allocator, true),
      "rcl_timer_init2");
  }
  Timer(const Timer &) = delete;
  Timer & operator=(const Timer &) = delete;
  ~Timer() {
    report_rcl(rcl_timer_fini(&timer_));
    report_rcl(rcl_clock_fini(&clock_));
  }
  rcl_timer_t & get() { return timer_; }

private:
  rcl_clock_t clock_{};
  rcl_timer_t timer_ = rcl_get_zero_initialized_timer();
};

/// Waits for everything a node has, as the executors of rclcpp and rclpy do.
class WaitSet {
public:
  WaitSet(RclContext & context, const RclNode & node, Timer * timer, const Interruption & end)
  : node_(node), timer_(timer), end_(end) {
    check_rcl(
      rcl_wait_set_init(
        &wait_set_, node.subscriptions().size(), 1, timer ? 1 : 0, 0, node.services().size(), 0,
        &context.get(), rcl_get_default_allocator()),
      "rcl_wait_set_init");
  }
  WaitSet(const WaitSet &) = delete;
  WaitSet & operator=(const WaitSet &) = delete;
  ~WaitSet() { report_rcl(rcl_wait_set_fini(&wait_set_)); }

  void wait() {
    check_rcl(rcl_wait_set_clear(&wait_set_), "rcl_wait_set_clear");
    for (const rcl_subscription_t & subscription : node_.subscriptions()) {
      check_rcl(rcl_wait_set_add_subscription(&wait_set_, &subscription, nullptr), "rcl_wait_set");
    }
    for (const rcl_service_t & service : node_.services()) {
      check_rcl(rcl_wait_set_add_service(&wait_set_, &service, nullptr), "rcl_wait_set");
    }
    if (timer_) {
      check_rcl(rcl_wait_set_add_timer(&wait_set_, &timer_->get(), nullptr), "rcl_wait_set");
    }
    check_rcl(
      rcl_wait_set_add_guard_condition(&wait_set_, &end_.guard_condition(), nullptr),
      "rcl_wait_set");
    const rcl_ret_t status = rcl_wait(&wait_set_, -1);
    if (status != RCL_RET_TIMEOUT) {
      check_rcl(status, "rcl_wait");
    }
    refuse_requests();
  }

  bool is_timer_ready() const { return timer_ && wait_set_.timers[0]; }

  bool is_ready(const rcl_subscription_t & subscription) const {
    for (size_t i = 0; i < wait_set_.size_of_subscriptions; ++i) {
      if (wait_set_.subscriptions[i] == &subscription) {
        return true;
      }
    }
    return false;
  }

private:
  void refuse_requests() const {
    for (size_t i = 0; i < wait_set_.size_of_services; ++i) {
      if (wait_set_.services[i]) {
        throw std::runtime_error("a request has come, and this node serves none");
      }
    }
  }

  const RclNode & node_;
  Timer * const timer_;
  const Interruption & end_;
  rcl_wait_set_t wait_set_ = rcl_get_zero_initialized_wait_set();
};

}  // namespace

void spin(RclContext & context, const RclNode & node, Kind & kind, const Interruption & end) {
  std::optional<Timer> timer;
  if (const auto period = kind.period()) {
    timer.emplace(context, *period);
  }
  WaitSet wait_set(context, node, timer ? &*timer : nullptr, end);
  while (true) {
    wait_set.wait();
    if (is_interrupted()) {
      return;
    }
    if (wait_set.is_timer_ready()) {
      check_rcl(rcl_timer_call(&timer->get()), "rcl_timer_call");
      kind.tick();
    }
    for (size_t i = 0; i < kind.inputs().size(); ++i) {
      Input & input = kind.inputs()[i];
      if (wait_set.is_ready(input.subscription()) && input.take()) {
        kind.receive(i);
      }
    }
  }
}

}  // namespace manycore::bench::reference
