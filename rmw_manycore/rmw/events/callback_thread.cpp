// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback_thread.hpp"

#include <algorithm>
#include <optional>

#include "platform/blocked_signals.hpp"

namespace rmw_manycore {
namespace {

/// Afterwards one push_back() cannot fail.
void make_room(std::vector<Callback *> & callbacks) {
  if (callbacks.size() == callbacks.capacity()) {
    callbacks.reserve(std::max<size_t>(4, 2 * callbacks.size()));
  }
}

void erase(std::vector<Callback *> & callbacks, const Callback * callback) noexcept {
  callbacks.erase(std::remove(callbacks.begin(), callbacks.end(), callback), callbacks.end());
}

}  // namespace

CallbackThread::~CallbackThread() {
  stop();
  if (has_callback_word_) {
    waiters_.give_back_callback_word();
  }
}

/// What may fail comes first.
void CallbackThread::add(Callback & callback) {
  if (std::find(active_.begin(), active_.end(), &callback) != active_.end()) {
    return;
  }
  make_room(active_);
  Bucket * const bucket = bucket_of(callback);
  if (bucket != nullptr) {
    make_room(bucket->callbacks);
  }
  start();
  active_.push_back(&callback);
  if (bucket != nullptr) {
    bucket->callbacks.push_back(&callback);
    bucket->count.store(bucket->callbacks.size(), std::memory_order_release);
  }
  ++changes_;
  wake_.notify_all();
  wake_sleep();  // a sleeping thread has neither this callback's watchers nor its due time
}

void CallbackThread::remove(Callback & callback) noexcept {
  erase(active_, &callback);
  if (Bucket * const bucket = bucket_of(callback)) {
    erase(bucket->callbacks, &callback);
    bucket->count.store(bucket->callbacks.size(), std::memory_order_release);
  }
  ++changes_;
}

CallbackThread::Bucket * CallbackThread::bucket_of(const Callback & callback) noexcept {
  const MessageTopic * const topic = callback.source_.topic;
  return topic == nullptr ? nullptr : &by_topic_[bucket_of(*topic)];
}

/// Acquire: the word was taken before the first callback came. Without a callback in sight the
/// thread is woken as usual.
manycore::WakeSet CallbackThread::spared(const MessageTopic & topic) const noexcept {
  const Bucket & bucket = by_topic_[bucket_of(topic)];
  return bucket.count.load(std::memory_order_acquire) != 0 && has_callback_word_
           ? manycore::WakeSet::of(manycore::callback_word)
           : manycore::WakeSet{};
}

void CallbackThread::report(const MessageTopic & topic) noexcept {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || is_calling_ || !report_all_of(topic)) {
    waiters_.of_word(manycore::callback_word).notify();
  }
}

bool CallbackThread::report_all_of(const MessageTopic & topic) {
  bool is_done = true;
  for_each(by_topic_[bucket_of(topic)].callbacks, [&](Callback & callback) {
    if (*callback.source_.topic == topic && !callback.report_known()) {
      is_done = false;
    }
  });
  return is_done;
}

void CallbackThread::start() {
  if (thread_.joinable() || stopping_) {
    return;
  }
  has_callback_word_ = has_callback_word_ || waiters_.take_callback_word();
  const manycore::BlockedSignals blocked;
  thread_ = std::thread([this] { run(); });
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
  const uint32_t word =
    has_callback_word_ ? manycore::callback_word : manycore::Waiters::word_of_this_thread();
  manycore::Waiter & waiter = waiters_.of_word(word);
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
    const int64_t due_ns = report_all();
    lock.unlock();
    waiter.wait(
      epoch, due_ns == manycore::infinite_ns ? std::nullopt : std::optional<int64_t>(due_ns));
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
    callback->source_.watchers.add(word);
  }
}

int64_t CallbackThread::report_all() {
  int64_t soonest_ns = manycore::infinite_ns;
  for_each(
    active_, [&](Callback & callback) { soonest_ns = std::min(soonest_ns, callback.report()); });
  return soonest_ns;
}

/// A child of fork() made by a callback goes no further: what has arrived is its parent's.
template<typename Visit>
void CallbackThread::for_each(const std::vector<Callback *> & callbacks, Visit visit) {
  uint64_t seen;
  do {
    seen = changes_;
    for (size_t i = 0; i < callbacks.size() && changes_ == seen && !stopping_; ++i) {
      if (side_.is_inherited()) {
        return;
      }
      visit(*callbacks[i]);
    }
  } while (changes_ != seen);
}

}  // namespace rmw_manycore
