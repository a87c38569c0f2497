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

}  // namespace

void spin(RclContext & context, const RclNode & node, Kind & kind, const Interruption & end) {
  std::optional<Timer> timer;
  if (const auto period = kind.period()) {
    timer.emplace(context, *period);
  }
  RclWaitSet wait_set(
    context.get(), {&node}, end.guard_condition(), timer ? &timer->get() : nullptr);
  while (true) {
    wait_set.wait();
    if (wait_set.has_request()) {
      throw std::runtime_error("unexpected request to a parameter service of this node");
    }
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
