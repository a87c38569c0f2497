// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/byte_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <ctime>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/lock_owner.hpp"

namespace manycore {
namespace {

struct flock range(short type, uint32_t first, uint32_t count) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = first;
  lock.l_len = count;
  return lock;
}

bool same_file(int fd, const std::string & path) {
  struct stat opened {};
  struct stat named {};
  return fstat(fd, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

void ByteLocks::create(const std::string & path) {
  const FileDescriptor fd(
    ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!fd) {
    throw_errno("cannot create " + path);
  }
}

ByteLocks ByteLocks::open(const std::string & path) {
  auto opened = std::make_shared<Opened>();
  opened->fd = FileDescriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
  if (!opened->fd) {
    throw_errno("cannot open " + path);
  }
  opened->path = path;
  return ByteLocks(std::move(opened));
}

bool ByteLocks::try_lock(uint32_t byte) const {
  struct flock lock = range(F_WRLCK, byte, 1);
  if (fcntl(opened_->fd.get(), F_SETLK, &lock) == 0) {
    const std::lock_guard<std::mutex> guard(opened_->mutex);
    opened_->bytes.insert(byte);
    return true;
  }
  if (errno != EAGAIN && errno != EACCES) {
    throw_errno("cannot lock " + opened_->path);
  }
  return false;
}

void ByteLocks::unlock(uint32_t byte) const noexcept {
  struct flock lock = range(F_UNLCK, byte, 1);
  fcntl(opened_->fd.get(), F_SETLK, &lock);
  const std::lock_guard<std::mutex> guard(opened_->mutex);
  opened_->bytes.erase(byte);
}

bool ByteLocks::is_held(uint32_t byte) const {
  {
    const std::lock_guard<std::mutex> guard(opened_->mutex);
    if (opened_->bytes.count(byte) != 0) {
      return true;
    }
  }
  return is_held_elsewhere(byte, 1);
}

bool ByteLocks::is_any_held() const { return holds_any() || is_held_elsewhere(0, 0); }

bool ByteLocks::holds_any() const {
  const std::lock_guard<std::mutex> guard(opened_->mutex);
  return !opened_->bytes.empty();
}

bool ByteLocks::is_current() const noexcept { return same_file(opened_->fd.get(), opened_->path); }

bool ByteLocks::is_held_elsewhere(uint32_t first, uint32_t count) const {
  struct flock lock = range(F_WRLCK, first, count);
  if (fcntl(opened_->fd.get(), F_GETLK, &lock) != 0) {
    throw_errno("cannot examine the locks of " + opened_->path);
  }
  return lock.l_type != F_UNLCK;
}

std::optional<FileLock> FileLock::acquire(const std::string & path, int timeout_ms) {
  const int64_t deadline = monotonic_ns() + int64_t{timeout_ms} * 1'000'000;
  while (true) {
    FileDescriptor fd(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!fd && errno == ENOENT) {
      return std::nullopt;
    }
    if (!fd) {
      throw_errno("cannot open " + path);
    }
    // Joining holds the lock for well under a millisecond, so a short pause between tries is
    // enough.
    while (flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) {
        throw_errno("cannot lock " + path);
      }
      if (monotonic_ns() > deadline) {
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
