// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback_thread.hpp"

#include <algorithm>
#include <optional>

#include "platform/blocked_signals.hpp"
#include "platform/clock.hpp"

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
  if (callback.is_active_) {
    return;
  }
  Callbacks & group = group_of(callback);
  make_room(group);
  Bucket * const bucket = bucket_of(callback);
  if (bucket != nullptr) {
    make_room(bucket->callbacks);
  }
  start();
  group.push_back(&callback);
  if (bucket != nullptr) {
    bucket->callbacks.push_back(&callback);
    bucket->count.store(bucket->callbacks.size(), std::memory_order_release);
  }
  callback.is_active_ = true;
  ++count_;
  is_any_new_ = true;
  ++changes_;
  wake_.notify_all();
  wake_sleep();  // a sleeping thread has neither this callback's watchers nor its due time
}

void CallbackThread::remove(Callback & callback) noexcept {
  if (!callback.is_active_) {
    return;
  }
  erase(group_of(callback), &callback);
  if (Bucket * const bucket = bucket_of(callback)) {
    erase(bucket->callbacks, &callback);
    bucket->count.store(bucket->callbacks.size(), std::memory_order_release);
  }
  callback.is_active_ = false;
  --count_;
  ++changes_;
}

CallbackThread::Callbacks & CallbackThread::group_of(const Callback & callback) noexcept {
  const Callback::Source & source = callback.source_;
  return source.topic == nullptr ? events_ : by_mark_[manycore::CallbackMarks::of(source.endpoint)];
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
    by_topic_[bucket_of(topic)].is_left = true;
    is_any_left_ = true;
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
    if (count_ == 0) {
      wake_.wait(lock);
      continue;
    }
    // Register watchers and read the epoch, then take the marks, then look: anything that happens
    // in between ends the wait at once. Only the callback word has marks.
    const bool looks_at_all = std::exchange(is_any_new_, false) || !has_callback_word_;
    if (looks_at_all) {
      watch_all(word);
    }
    const uint32_t epoch = waiter.epoch();
    manycore::CallbackMarks::Taken marks = manycore::CallbackMarks::everything();
    if (!looks_at_all) {
      marks = waiters_.callback_marks().take();
      marks.events = marks.events || manycore::monotonic_ns() >= due_ns_;
    }
    report_left();
    report_marked(marks);
    const int64_t due_ns = due_ns_;
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
  const auto watch = [word](const Callbacks & callbacks) {
    for (Callback * const callback : callbacks) {
      callback->source_.watchers.add(word);
    }
  };
  watch(events_);
  std::for_each(by_mark_.begin(), by_mark_.end(), watch);
}

void CallbackThread::report_marked(const manycore::CallbackMarks::Taken & marks) {
  marks.for_each_mark([this](uint32_t mark) {
    for_each(by_mark_[mark], [](Callback & callback) { callback.report(); });
  });
  if (marks.events) {
    due_ns_ = manycore::infinite_ns;
    for_each(
      events_, [this](Callback & callback) { due_ns_ = std::min(due_ns_, callback.report()); });
  }
}

void CallbackThread::report_left() {
  if (!is_any_left_.exchange(false)) {
    return;
  }
  for (Bucket & bucket : by_topic_) {
    if (bucket.is_left.exchange(false)) {
      for_each(bucket.callbacks, [](Callback & callback) { callback.report(); });
    }
  }
}

/// A child of fork() made by a callback goes no further: what has arrived is its parent's.
template<typename Visit>
void CallbackThread::for_each(const Callbacks & callbacks, Visit visit) {
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
