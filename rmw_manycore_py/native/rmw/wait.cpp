// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "platform/clock.hpp"
#include "rmw/checks.hpp"
#include "rmw/client.hpp"
#include "rmw/endpoint_events.hpp"
#include "rmw/error.hpp"
#include "rmw/guard_condition.hpp"
#include "rmw/rmw.h"
#include "rmw/service.hpp"
#include "rmw/subscription.hpp"
#include "rmw/time.h"
#include "rmw/wait_set.hpp"

namespace rmw_manycore {
namespace {

bool is_ready(Subscription & subscription) { return subscription.inbox().has_data(); }
bool is_ready(Service & service) { return service.requests().has_data(); }
bool is_ready(Client & client) { return client.replies().has_data(); }
bool is_ready(const GuardCondition & condition) { return condition.ready(); }
bool is_ready(const rmw_event_t & event) {
  return static_cast<const EndpointEvents *>(event.data)->ready(event.event_type);
}

bool take(GuardCondition & condition) { return condition.take(); }
/// Who is told of an event by a wait finds its callback called, as with other middlewares.
bool take(rmw_event_t & event) {
  const bool ready = is_ready(event);
  if (ready) {
    static_cast<EndpointEvents *>(event.data)->report(event.event_type);
  }
  return ready;
}
template <typename Entity>
bool take(Entity & entity) {
  return is_ready(entity);
}

/// One of the five arrays that rmw_wait is given, as entities. Entries may be null.
template <typename Entity>
class Entities {
public:
  Entities(void ** entries, size_t count) noexcept : entries_(entries), count_(count) {}

  template <typename Predicate>
  bool any(Predicate && predicate) const {
    for (size_t i = 0; i < count_; ++i) {
      if (entries_[i] != nullptr && predicate(at(i))) {
        return true;
      }
    }
    return false;
  }

  template <typename Visit>
  void for_each(Visit && visit) const {
    for (size_t i = 0; i < count_; ++i) {
      if (entries_[i] != nullptr) {
        visit(at(i));
      }
    }
  }

  bool any_ready() const {
    return any([](Entity & entity) { return is_ready(entity); });
  }

  /// Leaves only those that are ready; true if there are some. Resets guard conditions.
  bool keep_ready() {
    bool some = false;
    for (size_t i = 0; i < count_; ++i) {
      if (entries_[i] != nullptr && take(at(i))) {
        some = true;
      } else {
        entries_[i] = nullptr;
      }
    }
    return some;
  }

private:
  Entity & at(size_t i) const { return *static_cast<Entity *>(entries_[i]); }

  void ** entries_;
  size_t count_;
};

/// All that one call waits for.
struct Waited {
  Entities<Subscription> subscriptions;
  Entities<GuardCondition> conditions;
  Entities<Service> services;
  Entities<Client> clients;
  Entities<rmw_event_t> events;

  bool any_ready() const {
    return subscriptions.any_ready() || conditions.any_ready() || services.any_ready() ||
           clients.any_ready() || events.any_ready();
  }

  bool keep_ready() {
    bool some = subscriptions.keep_ready();
    some |= conditions.keep_ready();
    some |= services.keep_ready();
    some |= clients.keep_ready();
    some |= events.keep_ready();
    return some;
  }
};

/// Changes of graph and events raise the epoch while somebody watches; so only who waits for them
/// is woken by them.
class Watch {
public:
  Watch(manycore::Waiter & waiter, const Waited & waited) noexcept
  : waiter_(waiter),
    graph_(waited.conditions.any([](const GuardCondition & condition) {
      return condition.source() == GuardCondition::Source::graph;
    })),
    events_(waited.events.any([](const rmw_event_t &) { return true; })) {
    if (graph_) {
      waiter_.watch_graph();
    }
    if (events_) {
      waiter_.watch_endpoint_events();
    }
  }
  ~Watch() {
    if (events_) {
      waiter_.unwatch_endpoint_events();
    }
    if (graph_) {
      waiter_.unwatch_graph();
    }
  }
  Watch(const Watch &) = delete;
  Watch & operator=(const Watch &) = delete;

private:
  manycore::Waiter & waiter_;
  const bool graph_;
  const bool events_;
};

/// CLOCK_MONOTONIC; unset = no limit.
std::optional<int64_t> deadline_of(const rmw_time_t * timeout) noexcept {
  if (timeout == nullptr) {
    return std::nullopt;
  }
  const int64_t timeout_ns = rmw_time_total_nsec(*timeout);
  const int64_t now_ns = manycore::monotonic_ns();
  if (timeout_ns > INT64_MAX - now_ns) {
    return std::nullopt;
  }
  return now_ns + timeout_ns;
}

/// The earlier of the deadline and the moment when time alone makes an event ready.
std::optional<int64_t> with_due_events(
  const Waited & waited, std::optional<int64_t> deadline_ns) {
  int64_t soonest = deadline_ns.value_or(manycore::infinite_ns);
  waited.events.for_each([&](const rmw_event_t & event) {
    soonest = std::min(
      soonest, static_cast<const EndpointEvents *>(event.data)->next_due_ns(event.event_type));
  });
  return soonest == manycore::infinite_ns ? std::nullopt : std::optional(soonest);
}

/// Ends with the context as well: rclpy triggers its guard conditions before it shuts its contexts down on
/// SIGTERM, and would wait for ever if it came back here in between.
void sleep_until_ready(
  const WaitSet & wait_set, const Waited & waited, std::optional<int64_t> deadline_ns) {
  manycore::Waiter & waiter = wait_set.waiter();
  const Watch watch(waiter, waited);
  while (true) {
    // Epoch and due time are read before the entities: what happens or falls due in between ends the wait at once.
    const uint32_t epoch = waiter.epoch();
    const std::optional<int64_t> until_ns = with_due_events(waited, deadline_ns);
    if (wait_set.is_shutdown() || waited.any_ready()) {
      return;
    }
    if (!waiter.wait(epoch, until_ns) && until_ns == deadline_ns) {
      return;
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
    rmw_manycore::Waited waited{
      {subscriptions ? subscriptions->subscribers : nullptr,
       subscriptions ? subscriptions->subscriber_count : 0},
      {guard_conditions ? guard_conditions->guard_conditions : nullptr,
       guard_conditions ? guard_conditions->guard_condition_count : 0},
      {services ? services->services : nullptr, services ? services->service_count : 0},
      {clients ? clients->clients : nullptr, clients ? clients->client_count : 0},
      {events ? events->events : nullptr, events ? events->event_count : 0}};
    const bool poll = wait_timeout != nullptr && rmw_time_total_nsec(*wait_timeout) == 0;
    if (!poll && !waited.any_ready()) {
      rmw_manycore::sleep_until_ready(
        *static_cast<const rmw_manycore::WaitSet *>(wait_set->data), waited,
        rmw_manycore::deadline_of(wait_timeout));
    }
    return waited.keep_ready() ? RMW_RET_OK : RMW_RET_TIMEOUT;
  });
}
