// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "platform/fork_side.hpp"
#include "rmw/events/reporter.hpp"
#include "transport/waiting/waiters.hpp"

namespace rmw_manycore {

/// Calls the "on new message / request / response / event" callbacks of one context. Started when
/// the first callback is set; sleeps on its own wake word, and looks at what is marked when that is
/// raised. A thread of the context that publishes calls for its message itself. Thread-safe.
///
/// A thread that looks for arrivals and calls functions holds `turn_`, and the mutex of the
/// Reporter whose function it calls. add() and remove() take neither `turn_` nor the mutex of
/// another Reporter, so they wait for no other function. Lock order: `turn_`, Reporter::mutex(),
/// `mutex_`.
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
  /// Stops the thread; no other callback is called afterwards. From a callback it does not wait for
  /// the thread's end.
  void stop() noexcept;

  /// True in a child of fork(): the thread does not exist there, and mutexes may be locked forever.
  bool is_inherited() const noexcept { return side_.is_inherited(); }
  /// The right to call functions, unless another thread has it. In a function, the thread has it.
  std::unique_lock<std::recursive_mutex> try_turn() { return {turn_, std::try_to_lock}; }
  /// Makes the thread look for arrivals of all callbacks.
  void look_at_all() noexcept;
  /// Requires the mutex of the Reporter.
  void add(const std::shared_ptr<Reporter> & reporter);
  /// Clears the function, too. Waits until it does not run, unless called from it.
  void remove(Reporter & reporter) noexcept;

private:
  /// In the order in which they were added.
  using Reporters = std::vector<std::shared_ptr<Reporter>>;
  /// Reporters of topics with the same hash.
  struct Bucket {
    Reporters reporters;
    std::atomic<size_t> count{0};
    std::atomic<bool> is_left{false};  ///< to the thread, by report()
  };
  /// Afterwards one push_back() cannot fail.
  static void make_room(Reporters & reporters);
  static Reporters::const_iterator beyond(uint64_t order, const Reporters & reporters) noexcept;
  static void erase(Reporters & reporters, const Reporter & reporter) noexcept;
  size_t bucket_of(const MessageTopic & topic) const noexcept {
    return topic.hash() % by_topic_.size();
  }
  /// nullptr for events.
  Bucket * bucket_of(const Reporter & reporter) noexcept;
  /// Those that are looked at together with this one.
  Reporters & group_of(const Reporter & reporter) noexcept;
  void start();
  void run() noexcept;
  void report_marked(const manycore::CallbackMarks::Taken & marks);
  void report_left();  ///< what report() has left
  /// False if more may have arrived, which to find out would wait for another thread.
  bool report_all_of(const MessageTopic & topic);
  /// Includes those that are added meanwhile.
  template<typename Visit>
  void for_each(const Reporters & reporters, Visit visit);
  /// The first one beyond `order`, which becomes its own. Null at the end, after stop(), and in a
  /// child of fork().
  std::shared_ptr<Reporter> next(const Reporters & reporters, uint64_t & order) noexcept;
  void remove_all(const Reporters & reporters) noexcept;
  void wake_sleep() noexcept;
  void watch_all(uint32_t word) noexcept;

  manycore::Waiters & waiters_;
  const manycore::ForkSide side_;
  /// Held by the one thread that looks for arrivals and calls, so that functions that destroy each
  /// other's entities do not run at the same time.
  std::recursive_mutex turn_;
  std::mutex mutex_;  ///< guards what follows, to `stopping_`
  std::condition_variable wake_;
  Reporters events_;
  std::array<Reporters, manycore::CallbackMarks::count> by_mark_;  ///< of messages
  std::array<Bucket, 256> by_topic_;                               ///< the same again
  size_t count_ = 0;
  uint64_t last_order_ = 0;
  bool is_any_new_ = false;                ///< not yet seen by the thread
  manycore::Waiter * sleeping_ = nullptr;  ///< the waiter of the thread while it runs
  bool stopping_ = false;
  std::atomic<bool> is_any_left_{false};
  /// When the passage of time may raise the count of an event. Of the thread.
  int64_t due_ns_ = manycore::infinite_ns;
  /// One context of a process has it. Set before the first callback is in `by_topic_`.
  bool has_callback_word_ = false;
  std::thread thread_;
};

}  // namespace rmw_manycore
