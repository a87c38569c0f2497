// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/waiting/sleep.hpp"

#include <algorithm>

namespace rmw_manycore {

Sleep::Sleep(manycore::Waiters & own, const Waited & waited) : own_(own), waited_(waited) {
  waited.for_each_place([this](const Place & place) { add(place.waiters); });
}

/// The thread's word has the same number on all platforms.
void Sleep::watch() noexcept {
  const uint32_t word = manycore::Waiters::word_of_this_thread();
  waited_.for_each_place([&](const Place & place) { place.watchers.add(word); });
  waited_.conditions.for_each([&](const GuardCondition & condition) {
    if (condition.source() == GuardCondition::Source::graph) {
      condition.waiters().watch_graph(word);
    }
  });
}

void Sleep::watch_afresh() noexcept {
  own_.forget_this_thread();
  for (const Other & other : others_) {
    other.waiters->forget_this_thread();
  }
  watch();
}

void Sleep::read_epochs() noexcept {
  epoch_ = own_.of_this_thread().epoch();
  for (Other & other : others_) {
    other.epoch = other.waiters->of_this_thread().epoch();
  }
}

bool Sleep::until(std::optional<int64_t> deadline_ns) {
  manycore::Waiter & own = own_.of_this_thread();
  if (others_.empty()) {
    return own.wait(epoch_, deadline_ns);
  }
  std::vector<manycore::SeenEpoch> all{{&own, epoch_}};
  for (const Other & other : others_) {
    all.push_back({&other.waiters->of_this_thread(), other.epoch});
  }
  return manycore::wait_for_any(all, deadline_ns);
}

void Sleep::add(manycore::Waiters & waiters) {
  const auto is_known = [&](const Other & other) { return other.waiters == &waiters; };
  if (&waiters != &own_ && std::none_of(others_.begin(), others_.end(), is_known)) {
    others_.push_back({&waiters, 0});
  }
}

}  // namespace rmw_manycore
