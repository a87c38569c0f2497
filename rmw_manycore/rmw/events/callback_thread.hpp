// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "platform/fork_side.hpp"
#include "rmw/events/callback.hpp"
#include "transport/waiting/waiters.hpp"

namespace rmw_manycore {

/// Calls the "on new message / request / response / event" callbacks of one context. Started when
/// the first callback is set; sleeps on its own wake word, and looks at what is marked when that is
/// raised. A thread of the context that publishes calls for its message itself. Thread-safe.
class CallbackThread {
public:
  explicit CallbackThread(manycore::Waiters & waiters) noexcept : waiters_(waiters) {}
  ~CallbackThread();
  CallbackThread(const CallbackThread &) = delete;
  CallbackThread & operator=(const CallbackThread &) = delete;

  manycore::Waiters & waiters() const noexcept { return waiters_; }
  /// Words to spare when a message of `topic` is published. Unless empty, call report() afterwards,
  /// whether or not it was published.
  manycore::WakeSet spared(const MessageTopic & topic) const noexcept;
  /// Calls the callbacks for what has arrived on `topic`. Never waits for another thread: leaves it
  /// to this one if others are calling or taking. Nor does it call from a callback.
  void report(const MessageTopic & topic) noexcept;
  /// Stops the thread; no callback is called afterwards. Must not be called from a callback.
  void stop() noexcept;

private:
  friend class Callback;

  using Callbacks = std::vector<Callback *>;
  /// Callbacks for messages of topics with the same hash.
  struct Bucket {
    Callbacks callbacks;
    std::atomic<size_t> count{0};
    std::atomic<bool> is_left{false};  ///< to the thread, by report()
  };
  /// Marks that a callback runs. Requires the mutex.
  class Calling {
  public:
    explicit Calling(CallbackThread & thread) noexcept
    : thread_(thread), is_nested_(std::exchange(thread.is_calling_, true)) {}
    ~Calling() { thread_.is_calling_ = is_nested_; }
    Calling(const Calling &) = delete;
    Calling & operator=(const Calling &) = delete;

  private:
    CallbackThread & thread_;
    const bool is_nested_;
  };

  void add(Callback & callback);
  void remove(Callback & callback) noexcept;
  size_t bucket_of(const MessageTopic & topic) const noexcept {
    return topic.hash() % by_topic_.size();
  }
  /// nullptr for events.
  Bucket * bucket_of(const Callback & callback) noexcept;
  /// Those that are looked at together with this one.
  Callbacks & group_of(const Callback & callback) noexcept;
  void start();
  void run() noexcept;
  void report_marked(const manycore::CallbackMarks::Taken & marks);
  void report_left();  ///< what report() has left
  /// False if more may have arrived, which to find out would wait for another thread.
  bool report_all_of(const MessageTopic & topic);
  /// Starts over when a callback sets or clears callbacks.
  template<typename Visit>
  void for_each(const Callbacks & callbacks, Visit visit);
  void wake_sleep() noexcept;
  void watch_all(uint32_t word) noexcept;

  manycore::Waiters & waiters_;
  /// In a child of fork() the thread does not exist, and the mutex may be locked forever.
  const manycore::ForkSide side_;
  /// Held while a callback runs, so that none runs after it was cleared. Recursive, because a
  /// callback may set or clear callbacks.
  std::recursive_mutex mutex_;
  std::condition_variable_any wake_;
  // Active callbacks:
  Callbacks events_;
  std::array<Callbacks, manycore::CallbackMarks::count> by_mark_;  ///< of messages
  std::array<Bucket, 256> by_topic_;                               ///< the same again
  size_t count_ = 0;
  uint64_t changes_ = 0;     ///< of these lists
  bool is_any_new_ = false;  ///< not yet seen by the thread
  std::atomic<bool> is_any_left_{false};
  /// When the passage of time may raise the count of an event.
  int64_t due_ns_ = manycore::infinite_ns;
  manycore::Waiter * sleeping_ = nullptr;  ///< the waiter of the thread while it runs
  bool is_calling_ = false;
  bool stopping_ = false;
  /// One context of a process has it. Set before the first callback is in `by_topic_`.
  bool has_callback_word_ = false;
  std::thread thread_;
};

}  // namespace rmw_manycore
