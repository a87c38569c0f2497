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
  FlockThread(const FlockThread &) = delete;
  FlockThread & operator=(const FlockThread &) = delete;

  /// True once flock() has returned.
  bool wait_for_lock(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> guard(mutex_);
    return returned_.wait_for(guard, timeout, [this] { return error_ != waiting; });
  }
  /// Gives up if the thread is still waiting; otherwise lets it act. Returns the error of flock(),
  /// or `waiting`. Must be called once.
  int finish() {
    pthread_cancel(thread_);
    pthread_join(thread_, nullptr);
    if (error_ == waiting) {
      flock(fd_, LOCK_UN);  // the thread may have had the lock already
    }
    return error_;
  }

  static constexpr int waiting = -1;

private:
  /// flock() is no cancellation point, so the thread is cancelled asynchronously, in the system
  /// call only. Nothing is unwound here: this function has no object, and calls none that throws.
  static void * run(void * object) {
    auto & self = *static_cast<FlockThread *>(object);
    int error = 0;
    do {
      pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, nullptr);
      error = flock(self.fd_, LOCK_EX) == 0 ? 0 : errno;
      pthread_setcanceltype(PTHREAD_CANCEL_DEFERRED, nullptr);
    } while (error == EINTR);
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr);
    self.act_after(error);
    return nullptr;
  }

  [[gnu::noinline]] void act_after(int error) noexcept {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      error_ = error;
      returned_.notify_one();
    }
    if (error == 0) {
      act_();
    }
  }

  const int fd_;
  const std::function<void()> & act_;
  pthread_t thread_{};
  std::mutex mutex_;
  std::condition_variable returned_;
  int error_ = waiting;  ///< of flock()
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
  for (int i = 0; i < counted_timeouts && !thread.wait_for_lock(timeout); ++i) {
  }
  const int error = thread.finish();
  if (error > 0) {
    errno = error;
    throw_errno("cannot lock a file");
  }
  return error != FlockThread::waiting;
}

}  // namespace manycore
