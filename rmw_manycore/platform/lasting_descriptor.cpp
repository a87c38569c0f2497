// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/lasting_descriptor.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace manycore {

LastingDescriptor::LastingDescriptor(FileDescriptor fd, std::string path, int flags) noexcept
: path_(std::move(path)), flags_(flags) {
  struct stat status {};
  fstat(fd.get(), &status);
  device_ = status.st_dev;
  inode_ = status.st_ino;
  fd_.store(fd.release(), std::memory_order_relaxed);
}

LastingDescriptor::LastingDescriptor(LastingDescriptor && other) noexcept {
  *this = std::move(other);
}

/// Call before other threads use either object.
LastingDescriptor & LastingDescriptor::operator=(LastingDescriptor && other) noexcept {
  std::swap(path_, other.path_);
  std::swap(flags_, other.flags_);
  std::swap(device_, other.device_);
  std::swap(inode_, other.inode_);
  other.fd_.store(fd_.exchange(other.fd_.load()));
  return *this;
}

LastingDescriptor::~LastingDescriptor() {
  if (is_own(fd_.load(std::memory_order_relaxed))) {
    close(fd_.load(std::memory_order_relaxed));
  }
}

bool LastingDescriptor::is_own(int fd) const noexcept {
  struct stat status {};
  return fd >= 0 && fstat(fd, &status) == 0 && status.st_dev == device_ && status.st_ino == inode_;
}

bool LastingDescriptor::is_at(const std::string & path) const noexcept {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return errno != ENOENT && errno != ENOTDIR;  // on other errors the file may exist
  }
  return status.st_dev == device_ && status.st_ino == inode_;
}

int LastingDescriptor::get() const noexcept {
  int fd = fd_.load(std::memory_order_relaxed);
  if (is_own(fd)) {
    return fd;
  }
  const std::lock_guard<std::mutex> lock(reopening_);
  fd = fd_.load(std::memory_order_relaxed);
  if (is_own(fd)) {
    return fd;
  }
  FileDescriptor opened(open(path_.c_str(), flags_));
  if (!is_own(opened.get())) {
    errno = opened ? ENOENT : errno;
    return -1;
  }
  fd_.store(opened.release(), std::memory_order_relaxed);
  return fd_.load(std::memory_order_relaxed);
}

}  // namespace manycore
