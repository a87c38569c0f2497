// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/bounded_flock.hpp"

#include <pthread.h>
#include <sys/file.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "platform/blocked_signals.hpp"
#include "platform/error.hpp"

namespace manycore {
namespace {

/// A stopped process, or one of a stopped virtual machine, does not see that the lock was free
/// meanwhile. So the time is counted by timeouts that ended while the process could run.
constexpr int counted_timeouts = 10;

constexpr size_t stack_bytes = 1 << 20;

/// A thread that waits for the lock, and acts once it has it: flock() has no timeout, and a signal
/// that would interrupt it belongs to the program.
class FlockThread {
public:
  FlockThread(int fd, const std::function<void()> & act) : fd_(fd), act_(act) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, stack_bytes);
    const BlockedSignals blocked;
    errno = pthread_create(&thread_, &attributes, run, this);
    pthread_attr_destroy(&attributes);
    if (errno != 0) {
      throw_errno("cannot start a thread to wait for a lock");
    }
  }
  /// Gives up if the thread is still waiting.
  ~FlockThread() {
    pthread_cancel(thread_);
    pthread_join(thread_, nullptr);
  }
  FlockThread(const FlockThread &) = delete;
  FlockThread & operator=(const FlockThread &) = delete;

  /// True once flock() has returned.
  bool wait_for_lock(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> guard(mutex_);
    return changed_.wait_for(guard, timeout, [this] { return error_ != waiting; });
  }
  /// Returns the error of flock(), once the thread has acted if there was none.
  int wait_for_end() {
    std::unique_lock<std::mutex> guard(mutex_);
    changed_.wait(guard, [this] { return has_ended_; });
    return error_;
  }

private:
  /// flock() is no cancellation point, so the thread is cancelled asynchronously, in the system
  /// call only: nothing is to be unwound there.
  static void * run(void * object) {
    auto & self = *static_cast<FlockThread *>(object);
    int error = 0;
    do {
      pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, nullptr);
      error = flock(self.fd_, LOCK_EX) == 0 ? 0 : errno;
      pthread_setcanceltype(PTHREAD_CANCEL_DEFERRED, nullptr);
    } while (error == EINTR);
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr);
    self.note([&] { self.error_ = error; });
    if (error == 0) {
      self.act_();
    }
    self.note([&] { self.has_ended_ = true; });
    return nullptr;
  }

  template<typename Change>
  void note(Change change) {
    const std::lock_guard<std::mutex> guard(mutex_);
    change();
    changed_.notify_one();
  }

  static constexpr int waiting = -1;

  const int fd_;
  const std::function<void()> & act_;
  pthread_t thread_{};
  std::mutex mutex_;
  std::condition_variable changed_;
  int error_ = waiting;  ///< of flock()
  bool has_ended_ = false;
};

/// False if another process holds the lock.
bool try_flock(int fd) {
  while (flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) {
      return false;
    }
    if (errno != EINTR) {
      throw_errno("cannot lock a file");
    }
  }
  return true;
}

}  // namespace

bool flock_within(int fd, int timeout_ms, const std::function<void()> & act) {
  if (try_flock(fd)) {
    act();
    return true;
  }
  if (timeout_ms == 0) {
    return false;
  }
  FlockThread thread(fd, act);
  const std::chrono::milliseconds timeout(timeout_ms / counted_timeouts + 1);
  for (int i = 0; i < counted_timeouts; ++i) {
    if (thread.wait_for_lock(timeout)) {
      errno = thread.wait_for_end();
      if (errno != 0) {
        throw_errno("cannot lock a file");
      }
      return true;
    }
  }
  return false;
}

}  // namespace manycore
