// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback_thread.hpp"

#include <algorithm>

#include "platform/blocked_signals.hpp"

namespace rmw_manycore {

void CallbackThread::add(Callback & callback) {
  if (std::find(active_.begin(), active_.end(), &callback) != active_.end()) {
    return;
  }
  active_.push_back(&callback);
  changed_ = true;
  if (!thread_.joinable() && !stopping_) {
    const manycore::BlockedSignals blocked;
    thread_ = std::thread([this] { run(); });
  }
  wake_.notify_all();
  wake_sleep();  // a sleeping thread has neither this callback's watchers nor its due time
}

void CallbackThread::remove(Callback & callback) noexcept {
  active_.erase(std::remove(active_.begin(), active_.end(), &callback), active_.end());
  changed_ = true;
}

void CallbackThread::stop() noexcept {
  if (side_.is_inherited()) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
    wake_sleep();
  }
  if (thread_.joinable()) {
    thread_.join();
  }
}

void CallbackThread::run() noexcept {
  manycore::Waiter & waiter = waiters_.of_this_thread();
  const uint32_t word = manycore::Waiters::word_of_this_thread();
  std::unique_lock lock(mutex_);
  sleeping_ = &waiter;
  while (!stopping_) {
    if (active_.empty()) {
      wake_.wait(lock);
      continue;
    }
    // Register watchers and read the epoch before checking: anything that happens in between ends
    // the wait at once.
    watch_all(word);
    const uint32_t epoch = waiter.epoch();
    const std::optional<int64_t> due_ns = report_all();
    lock.unlock();
    waiter.wait(epoch, due_ns);
    lock.lock();
  }
  sleeping_ = nullptr;
}

void CallbackThread::wake_sleep() noexcept {
  if (sleeping_ != nullptr) {
    sleeping_->notify();
  }
}

void CallbackThread::watch_all(uint32_t word) noexcept {
  for (Callback * const callback : active_) {
    callback->watchers_.add(word);
  }
}

std::optional<int64_t> CallbackThread::report_all() noexcept {
  int64_t soonest_ns;
  do {
    changed_ = false;
    soonest_ns = manycore::infinite_ns;
    for (size_t i = 0; i < active_.size() && !changed_; ++i) {
      soonest_ns = std::min(soonest_ns, active_[i]->report());
    }
  } while (changed_);
  return soonest_ns == manycore::infinite_ns ? std::nullopt : std::optional(soonest_ns);
}

void Callback::set(rmw_event_callback_t function, const void * user_data) {
  if (function == nullptr) {
    clear();
    return;
  }
  const std::lock_guard lock(thread_.mutex_);
  function_ = function;
  user_data_ = user_data;
  const uint64_t arrivals = arrivals_().count;
  const uint64_t pending = std::min(unread_(), arrivals - reported_);
  reported_ = arrivals;
  if (pending != 0) {
    function_(user_data_, pending);
  }
  thread_.add(*this);
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

int64_t Callback::report() noexcept {
  const Arrivals arrivals = arrivals_();
  if (arrivals.count > reported_) {
    const uint64_t fresh = arrivals.count - reported_;
    reported_ = arrivals.count;
    function_(user_data_, fresh);
  }
  return arrivals.next_due_ns;
}

}  // namespace rmw_manycore
