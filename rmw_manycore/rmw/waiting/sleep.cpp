// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/waiting/sleep.hpp"

#include <algorithm>

namespace rmw_manycore {

Sleep::Sleep(manycore::Waiter & own, const Waited & waited)
: own_(own),
  graph_(waited.conditions.any([](const GuardCondition & condition) {
    return condition.source() == GuardCondition::Source::graph;
  })),
  events_(waited.events.any([](const rmw_event_t &) { return true; })) {
  waited.for_each_waiter([this](manycore::Waiter & waiter) { add(waiter); });
  watch(own_);
  for (const manycore::SeenEpoch & other : others_) {
    watch(*other.waiter);
  }
}

Sleep::~Sleep() {
  unwatch(own_);
  for (const manycore::SeenEpoch & other : others_) {
    unwatch(*other.waiter);
  }
}

void Sleep::read_epochs() noexcept {
  epoch_ = own_.epoch();
  for (manycore::SeenEpoch & other : others_) {
    other.epoch = other.waiter->epoch();
  }
}

bool Sleep::until(std::optional<int64_t> deadline_ns) {
  if (others_.empty()) {
    return own_.wait(epoch_, deadline_ns);
  }
  std::vector<manycore::SeenEpoch> all = others_;
  all.push_back({&own_, epoch_});
  return manycore::wait_for_any(all, deadline_ns);
}

void Sleep::add(manycore::Waiter & waiter) {
  const auto is_known = [&](const manycore::SeenEpoch & other) { return other.waiter == &waiter; };
  if (&waiter != &own_ && std::none_of(others_.begin(), others_.end(), is_known)) {
    others_.push_back({&waiter, 0});
  }
}

void Sleep::watch(manycore::Waiter & waiter) const noexcept {
  if (graph_) {
    waiter.watch_graph();
  }
  if (events_) {
    waiter.watch_endpoint_events();
  }
}

void Sleep::unwatch(manycore::Waiter & waiter) const noexcept {
  if (events_) {
    waiter.unwatch_endpoint_events();
  }
  if (graph_) {
    waiter.unwatch_graph();
  }
}

}  // namespace rmw_manycore
