// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/callback_thread.hpp"

#include <algorithm>
#include <optional>

#include "platform/blocked_signals.hpp"
#include "virtual_time/door.hpp"

namespace rmw_manycore {

CallbackThread::~CallbackThread() {
  stop();
  if (has_callback_word_) {
    waiters_.give_back_callback_word();
  }
}

/// What may fail comes first.
void CallbackThread::add(const std::shared_ptr<Reporter> & reporter) {
  const std::lock_guard lock(mutex_);
  if (reporter->order_ != 0) {
    return;
  }
  Reporters & group = group_of(*reporter);
  make_room(group);
  Bucket * const bucket = bucket_of(*reporter);
  if (bucket != nullptr) {
    make_room(bucket->reporters);
  }
  start();
  group.push_back(reporter);
  if (bucket != nullptr) {
    bucket->reporters.push_back(reporter);
    bucket->count.store(bucket->reporters.size(), std::memory_order_release);
  }
  reporter->order_ = ++last_order_;
  ++count_;
  is_any_new_ = true;
  wake_.notify_all();
  wake_sleep();  // a sleeping thread has neither this reporter's watchers nor its due time
}

void CallbackThread::look_at_all() noexcept {
  const std::lock_guard lock(mutex_);
  is_any_new_ = true;
  wake_sleep();
}

void CallbackThread::remove(Reporter & reporter) noexcept {
  const std::lock_guard running(reporter.mutex());
  reporter.clear();
  const std::lock_guard lock(mutex_);
  if (reporter.order_ == 0) {
    return;
  }
  erase(group_of(reporter), reporter);
  if (Bucket * const bucket = bucket_of(reporter)) {
    erase(bucket->reporters, reporter);
    bucket->count.store(bucket->reporters.size(), std::memory_order_release);
  }
  reporter.order_ = 0;
  --count_;
}

void CallbackThread::make_room(Reporters & reporters) {
  if (reporters.size() == reporters.capacity()) {
    reporters.reserve(std::max<size_t>(4, 2 * reporters.size()));
  }
}

CallbackThread::Reporters::const_iterator CallbackThread::beyond(
  uint64_t order, const Reporters & reporters) noexcept {
  return std::upper_bound(
    reporters.begin(), reporters.end(), order,
    [](uint64_t value, const auto & reporter) { return value < reporter->order_; });
}

void CallbackThread::erase(Reporters & reporters, const Reporter & reporter) noexcept {
  reporters.erase(beyond(reporter.order_ - 1, reporters));
}

CallbackThread::Reporters & CallbackThread::group_of(const Reporter & reporter) noexcept {
  const Reporter::Source & source = reporter.source();
  return source.topic ? by_mark_[manycore::CallbackMarks::of(source.endpoint)] : events_;
}

CallbackThread::Bucket * CallbackThread::bucket_of(const Reporter & reporter) noexcept {
  const std::optional<MessageTopic> & topic = reporter.source().topic;
  return topic ? &by_topic_[bucket_of(*topic)] : nullptr;
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
  if (Reporter::is_calling() || !report_all_of(topic)) {
    by_topic_[bucket_of(topic)].is_left = true;
    is_any_left_ = true;
    waiters_.of_word(manycore::callback_word).notify();
  }
}

bool CallbackThread::report_all_of(const MessageTopic & topic) {
  const std::unique_lock turn = try_turn();
  if (!turn) {
    return false;
  }
  bool is_done = true;
  for_each(by_topic_[bucket_of(topic)].reporters, [&](Reporter & reporter) {
    if (*reporter.source().topic == topic) {
      const std::unique_lock lock(reporter.mutex(), std::try_to_lock);
      is_done = lock && reporter.report_known() && is_done;
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
  // The thread would wait for itself in a callback of its own, and in that of another for the turn
  // that this one has.
  if (thread_.joinable() && !Reporter::is_calling()) {
    thread_.join();
  }
  remove_all(events_);  // other threads may be calling
  for (const Reporters & reporters : by_mark_) {
    remove_all(reporters);
  }
}

void CallbackThread::remove_all(const Reporters & reporters) noexcept {
  std::unique_lock lock(mutex_);
  while (!reporters.empty()) {
    const std::shared_ptr<Reporter> last = reporters.back();
    lock.unlock();
    remove(*last);
    lock.lock();
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
    const uint32_t epoch = waiter.epoch();  // with the lock: add() and stop() notify with it
    lock.unlock();
    manycore::CallbackMarks::Taken marks = manycore::CallbackMarks::everything();
    if (!looks_at_all) {
      marks = waiters_.callback_marks().take();
      marks.events = marks.events || manycore::qos_now_ns() >= due_ns_;
    }
    {
      const std::lock_guard turn(turn_);
      report_left();
      report_marked(marks);
    }
    waiter.wait(
      epoch, due_ns_ == manycore::infinite_ns ? std::nullopt : std::optional<int64_t>(due_ns_));
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
  const auto watch = [word](const Reporters & reporters) {
    for (const std::shared_ptr<Reporter> & reporter : reporters) {
      reporter->source().watchers.add(word);
    }
  };
  watch(events_);
  std::for_each(by_mark_.begin(), by_mark_.end(), watch);
}

void CallbackThread::report_marked(const manycore::CallbackMarks::Taken & marks) {
  marks.for_each_mark([this](uint32_t mark) {
    for_each(by_mark_[mark], [](Reporter & reporter) {
      const std::lock_guard lock(reporter.mutex());
      reporter.report();
    });
  });
  if (marks.events) {
    due_ns_ = manycore::infinite_ns;
    for_each(events_, [this](Reporter & reporter) {
      const std::lock_guard lock(reporter.mutex());
      due_ns_ = std::min(due_ns_, reporter.report());
    });
  }
}

void CallbackThread::report_left() {
  if (!is_any_left_.exchange(false)) {
    return;
  }
  for (Bucket & bucket : by_topic_) {
    if (bucket.is_left.exchange(false)) {
      for_each(bucket.reporters, [](Reporter & reporter) {
        const std::lock_guard lock(reporter.mutex());
        reporter.report();
      });
    }
  }
}

std::shared_ptr<Reporter> CallbackThread::next(
  const Reporters & reporters, uint64_t & order) noexcept {
  if (is_inherited()) {  // a callback has forked: what has arrived is its parent's
    return nullptr;
  }
  const std::lock_guard lock(mutex_);
  const auto found = beyond(order, reporters);
  if (stopping_ || found == reporters.end()) {
    return nullptr;
  }
  order = (*found)->order_;
  return *found;
}

template<typename Visit>
void CallbackThread::for_each(const Reporters & reporters, Visit visit) {
  uint64_t order = 0;
  while (const std::shared_ptr<Reporter> reporter = next(reporters, order)) {
    visit(*reporter);
  }
}

}  // namespace rmw_manycore
