// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback.hpp"

#include <algorithm>
#include <mutex>

#include "rmw/events/callback_thread.hpp"

namespace rmw_manycore {

void Callback::set(rmw_event_callback_t function, const void * user_data) {
  if (function == nullptr) {
    clear();
    return;
  }
  if (thread_.side_.is_inherited()) {
    return;
  }
  const std::lock_guard lock(thread_.mutex_);
  thread_.add(*this);
  function_ = function;
  user_data_ = user_data;
  const uint64_t arrivals = source_.arrivals().count;
  const uint64_t pending = std::min(source_.unread(), arrivals - reported_);
  reported_ = arrivals;
  if (pending != 0) {
    call(pending);
  }
}

void Callback::report_now() {
  const std::lock_guard lock(thread_.mutex_);
  if (function_ != nullptr) {
    report();
  }
}

void Callback::clear() noexcept {
  if (thread_.side_.is_inherited()) {
    return;
  }
  const std::lock_guard lock(thread_.mutex_);
  function_ = nullptr;
  thread_.remove(*this);
}

int64_t Callback::report() {
  const Arrivals arrivals = source_.arrivals();
  report_up_to(arrivals.count);
  return arrivals.next_due_ns;
}

bool Callback::report_known() {
  const Known known = source_.known();
  report_up_to(known.count);
  return known.is_all;
}

void Callback::report_up_to(uint64_t count) {
  if (count > reported_) {
    const uint64_t fresh = count - reported_;
    reported_ = count;
    call(fresh);
  }
}

void Callback::call(uint64_t arrivals) {
  const CallbackThread::Calling calling(thread_);
  function_(user_data_, arrivals);
}

}  // namespace rmw_manycore
