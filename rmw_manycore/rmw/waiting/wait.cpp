// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/time.h"
#include "rmw/waiting/sleep.hpp"
#include "rmw/waiting/wait_set.hpp"
#include "rmw/waiting/waited.hpp"
#include "virtual_time/door.hpp"

namespace rmw_manycore {
namespace {

/// CLOCK_MONOTONIC; unset = no limit.
std::optional<int64_t> deadline_of(const rmw_time_t * timeout) noexcept {
  if (timeout == nullptr) {
    return std::nullopt;
  }
  const int64_t timeout_ns = rmw_time_total_nsec(*timeout);
  const int64_t now_ns = manycore::qos_now_ns();
  if (timeout_ns > INT64_MAX - now_ns) {
    return std::nullopt;
  }
  return now_ns + timeout_ns;
}

/// The earlier of the deadline and the time at which an event becomes ready by itself.
std::optional<int64_t> with_due_events(const Waited & waited, std::optional<int64_t> deadline_ns) {
  int64_t soonest = deadline_ns.value_or(manycore::infinite_ns);
  waited.events.for_each([&](const rmw_event_t & event) {
    soonest = std::min(
      soonest, static_cast<const EndpointEvents *>(event.data)->next_due_ns(event.event_type));
  });
  return soonest == manycore::infinite_ns ? std::nullopt : std::optional(soonest);
}

/// How a wait ended. RMW_RET_TIMEOUT is returned only if the caller's timeout has passed: rclcpp's
/// graph listener waits without one, and treats that return code as a fatal error.
enum class Ended { woken, by_timeout };

/// Also ends when the context is shut down: on SIGTERM, rclpy triggers its guard conditions before
/// it shuts down its contexts, and would wait forever if it re-entered the wait in between.
Ended sleep_until_ready(
  const WaitSet & wait_set, const Waited & waited, std::optional<int64_t> deadline_ns) {
  Sleep sleep(wait_set.waiters(), waited);
  sleep.watch();
  while (true) {
    // Read epochs and due times before checking the entities: anything that happens or falls due in
    // between ends the wait at once.
    sleep.read_epochs();
    const std::optional<int64_t> until_ns = with_due_events(waited, deadline_ns);
    if (wait_set.is_shutdown() || wait_set.is_cut_off() || waited.any_ready()) {
      return Ended::woken;
    }
    if (!sleep.until(until_ns) && until_ns == deadline_ns) {
      return Ended::by_timeout;
    }
    if (!waited.any_ready()) {
      sleep.watch_afresh();
    }
  }
}

}  // namespace
}  // namespace rmw_manycore

rmw_ret_t rmw_wait(
  rmw_subscriptions_t * subscriptions, rmw_guard_conditions_t * guard_conditions,
  rmw_services_t * services, rmw_clients_t * clients, rmw_events_t * events,
  rmw_wait_set_t * wait_set, const rmw_time_t * wait_timeout) {
  // Invariants
  MANYCORE_CHECK_HANDLE(wait_set);

  // Implementation
  return rmw_manycore::guarded([&] {
    const auto & sleeper = *static_cast<const rmw_manycore::WaitSet *>(wait_set->data);
    sleeper.require_membership();
    rmw_manycore::Waited waited{
      {subscriptions ? subscriptions->subscribers : nullptr,
       subscriptions ? subscriptions->subscriber_count : 0},
      {guard_conditions ? guard_conditions->guard_conditions : nullptr,
       guard_conditions ? guard_conditions->guard_condition_count : 0},
      {services ? services->services : nullptr, services ? services->service_count : 0},
      {clients ? clients->clients : nullptr, clients ? clients->client_count : 0},
      {events ? events->events : nullptr, events ? events->event_count : 0}};
    manycore::Tracer & tracer = sleeper.tracer();
    tracer.note(
      manycore::TraceKind::wait_begin, manycore::nothing, 0,
      wait_timeout == nullptr ? UINT64_MAX
                              : static_cast<uint64_t>(rmw_time_total_nsec(*wait_timeout)));
    const bool poll = wait_timeout != nullptr && rmw_time_total_nsec(*wait_timeout) == 0;
    manycore::virtual_time::end_turn(poll, [&] { return waited.any_ready(); });
    auto ended = poll ? rmw_manycore::Ended::by_timeout : rmw_manycore::Ended::woken;
    if (!poll && !waited.any_ready()) {
      const std::optional<int64_t> deadline_ns = rmw_manycore::deadline_of(wait_timeout);
      ended = rmw_manycore::sleep_until_ready(sleeper, waited, deadline_ns);
      manycore::virtual_time::elapse(manycore::virtual_time::Step::woken);
    }
    const bool some_ready = waited.keep_ready();
    tracer.note(manycore::TraceKind::wait_end, manycore::nothing, 0, some_ready ? 1 : 0);
    return some_ready || ended == rmw_manycore::Ended::woken ? RMW_RET_OK : RMW_RET_TIMEOUT;
  });
}
