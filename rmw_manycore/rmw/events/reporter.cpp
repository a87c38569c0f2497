// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/reporter.hpp"

#include <algorithm>

namespace rmw_manycore {
namespace {

thread_local bool is_calling_here = false;

class Calling {
public:
  Calling() noexcept : is_nested_(std::exchange(is_calling_here, true)) {}
  ~Calling() { is_calling_here = is_nested_; }
  Calling(const Calling &) = delete;
  Calling & operator=(const Calling &) = delete;

private:
  const bool is_nested_;
};

}  // namespace

bool Reporter::is_calling() noexcept { return is_calling_here; }

void Reporter::set(rmw_event_callback_t function, const void * user_data) {
  function_ = function;
  user_data_ = user_data;
  const uint64_t arrivals = source_.arrivals().count;
  reported_ = arrivals - std::min(source_.unread(), arrivals - reported_);
  note_called(reported_);
}

void Reporter::clear() noexcept {
  function_ = nullptr;
  note_called(all);
}

int64_t Reporter::report() {
  if (function_ == nullptr) {
    return manycore::infinite_ns;
  }
  const Arrivals arrivals = source_.arrivals();
  report_up_to(arrivals.count);
  return arrivals.next_due_ns;
}

bool Reporter::report_known() {
  if (function_ == nullptr) {
    return true;
  }
  const Known known = source_.known();
  report_up_to(known.count);
  return known.is_all;
}

void Reporter::report_up_to(uint64_t count) {
  if (count > reported_) {
    const uint64_t fresh = count - reported_;
    reported_ = count;
    call(fresh);
    if (function_ != nullptr) {  // it may clear itself
      note_called(reported_);
    }
  }
}

/// The store is seq_cst like all before a notification, see Watchers.
void Reporter::note_called(uint64_t count) noexcept {
  if (source_.notify_called) {
    called_.store(count, std::memory_order_seq_cst);
    source_.notify_called();
  }
}

void Reporter::call(uint64_t arrivals) {
  const Calling calling;
  function_(user_data_, arrivals);
}

}  // namespace rmw_manycore
