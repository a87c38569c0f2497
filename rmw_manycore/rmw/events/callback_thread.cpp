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
    // Register watchers and read epoch and due time before checking: anything that happens or falls
    // due in between ends the wait at once.
    watch_all(word);
    const uint32_t epoch = waiter.epoch();
    const std::optional<int64_t> due_ns = next_due_ns();
    report_all();
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

std::optional<int64_t> CallbackThread::next_due_ns() const {
  int64_t soonest = manycore::infinite_ns;
  for (const Callback * const callback : active_) {
    soonest = std::min(soonest, callback->next_due_ns_());
  }
  return soonest == manycore::infinite_ns ? std::nullopt : std::optional(soonest);
}

void CallbackThread::report_all() noexcept {
  do {
    changed_ = false;
    for (size_t i = 0; i < active_.size() && !changed_; ++i) {
      active_[i]->report();
    }
  } while (changed_);
}

void Callback::set(rmw_event_callback_t function, const void * user_data) {
  if (function == nullptr) {
    clear();
    return;
  }
  const std::lock_guard lock(thread_.mutex_);
  function_ = function;
  user_data_ = user_data;
  const uint64_t arrivals = arrivals_();
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

void Callback::report() noexcept {
  const uint64_t arrivals = arrivals_();
  if (arrivals > reported_) {
    const uint64_t fresh = arrivals - reported_;
    reported_ = arrivals;
    function_(user_data_, fresh);
  }
}

}  // namespace rmw_manycore
