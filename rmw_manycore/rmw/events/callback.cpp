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
  const std::lock_guard lock(reporter->mutex());
  thread_.add(reporter);
  reporter->set(function, user_data);
}

void Callback::report_now() {
  const std::shared_ptr<Reporter> reporter = reporter_;
  const std::lock_guard lock(reporter->mutex());
  reporter->report();
}

void Callback::clear() noexcept {
  if (!thread_.is_inherited()) {
    thread_.remove(*reporter_);
  }
}

}  // namespace rmw_manycore
