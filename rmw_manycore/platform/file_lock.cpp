// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <utility>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/lock_owner.hpp"

namespace manycore {
namespace {

/// A waiter that did not run for a while, as a whole virtual machine may not, has not seen that the
/// lock was free meanwhile. So at most this much counts between two looks.
constexpr int64_t longest_between_looks_ns = 10'000'000;

bool same_file(int fd, const std::string & path) {
  struct stat opened {};
  struct stat named {};
  return fstat(fd, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::~FileLock() {
  if (fd_) {
    flock(fd_.get(), LOCK_UN);
  }
}

std::optional<FileLock> FileLock::acquire(const std::string & path, int timeout_ms) {
  int64_t left_ns = int64_t{timeout_ms} * 1'000'000;
  int64_t last_ns = monotonic_ns();
  while (true) {
    FileDescriptor fd(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!fd && errno == ENOENT) {
      return std::nullopt;
    }
    if (!fd) {
      throw_errno("cannot open " + path);
    }
    // Joining holds the lock for far less than a millisecond, so polling is sufficient.
    while (flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) {
        throw_errno("cannot lock " + path);
      }
      const int64_t now_ns = monotonic_ns();
      left_ns -= std::min(now_ns - std::exchange(last_ns, now_ns), longest_between_looks_ns);
      if (left_ns < 0) {
        throw Error(
          ErrorCode::timeout, path + " has been locked for " + std::to_string(timeout_ms) +
                                " ms: " + describe_flock_owner(fd.get()));
      }
      const timespec pause = to_timespec(200'000);
      nanosleep(&pause, nullptr);
    }
    if (same_file(fd.get(), path)) {
      return FileLock(std::move(fd));
    }
  }
}

}  // namespace manycore
