// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback.hpp"

#include <mutex>

#include "rmw/events/callback_thread.hpp"

namespace rmw_manycore {

void Callback::set(rmw_event_callback_t function, const void * user_data) {
  if (function == nullptr) {
    clear();
    return;
  }
  if (thread_.is_inherited()) {
    return;
  }
  const std::shared_ptr<Reporter> reporter = reporter_;  // survives this object
  const std::unique_lock turn = thread_.try_turn();
  const std::lock_guard lock(reporter->mutex());
  thread_.add(reporter);
  reporter->set(function, user_data);
  // Functions that run at the same time could wait for each other to clear their callbacks.
  if (turn.owns_lock()) {
    reporter->report();
  } else {
    thread_.look_at_all();
  }
}

bool Callback::has_called_for(uint64_t count) const noexcept {
  return thread_.is_inherited() || reporter_->called() >= count;
}

void Callback::clear() noexcept {
  if (!thread_.is_inherited()) {
    thread_.remove(*reporter_);
  }
}

}  // namespace rmw_manycore
