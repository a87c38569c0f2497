// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/context/guard_condition.hpp"
#include "rmw/events/endpoint_events.hpp"
#include "rmw/services/client.hpp"
#include "rmw/services/service.hpp"
#include "rmw/topics/subscription.hpp"

namespace rmw_manycore {

/// True if a wait for the entity would return at once.
inline bool is_ready(Subscription & subscription) { return subscription.inbox().has_data(); }
inline bool is_ready(Service & service) { return service.requests().has_data(); }
inline bool is_ready(Client & client) { return client.replies().has_data(); }
inline bool is_ready(const GuardCondition & condition) { return condition.ready(); }
inline bool is_ready(const rmw_event_t & event) {
  return static_cast<const EndpointEvents *>(event.data)->ready(event.event_type);
}

/// The waiters that threads waiting for an entity sleep on, and the watchers to register with.
struct Place {
  manycore::Waiters & waiters;
  manycore::Watchers & watchers;
};
inline Place place_of(const Inbox & inbox) {
  return {inbox.watched().waiters(), inbox.watched().watchers()};
}
inline Place place_of(Subscription & subscription) { return place_of(subscription.inbox()); }
inline Place place_of(Service & service) { return place_of(service.requests()); }
inline Place place_of(Client & client) { return place_of(client.replies()); }
inline Place place_of(GuardCondition & condition) {
  return {condition.waiters(), condition.watchers()};
}
inline Place place_of(const rmw_event_t & event) {
  manycore::Waiters & waiters = static_cast<const EndpointEvents *>(event.data)->waiters();
  return {waiters, waiters.event_watchers()};
}

/// As is_ready(), at the end of a wait; resets a guard condition.
inline bool take(GuardCondition & condition) { return condition.take(); }
template<typename Entity>
bool take(Entity & entity) {
  return is_ready(entity);
}

/// One of the five entity arrays passed to rmw_wait. Entries may be null.
template<typename Entity>
class Entities {
public:
  Entities(void ** entries, size_t count) noexcept : entries_(entries), count_(count) {}

  template<typename Predicate>
  bool any(Predicate && predicate) const {
    for (size_t i = 0; i < count_; ++i) {
      if (entries_[i] != nullptr && predicate(at(i))) {
        return true;
      }
    }
    return false;
  }

  template<typename Visit>
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

  /// Sets entries that are not ready to null; true if some are ready. Resets guard conditions.
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

/// All entities of one rmw_wait() call.
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

  template<typename Visit>
  void for_each_place(Visit && visit) const {
    const auto visit_place = [&](auto & entity) { visit(place_of(entity)); };
    subscriptions.for_each(visit_place);
    conditions.for_each(visit_place);
    services.for_each(visit_place);
    clients.for_each(visit_place);
    events.for_each(visit_place);
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

}  // namespace rmw_manycore
