// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <exception>
#include <utility>

#include "platform/bounded_flock.hpp"
#include "platform/error.hpp"
#include "platform/lock_owner.hpp"
#include "platform/private_directory.hpp"

namespace manycore {
namespace {

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
  return acquire(path, O_CREAT, timeout_ms, [] {});
}

std::optional<FileLock> FileLock::acquire_existing(const std::string & path, int timeout_ms) {
  return acquire(path, 0, timeout_ms, [] {});
}

bool FileLock::run(const std::string & path, int timeout_ms, const std::function<void()> & act) {
  std::exception_ptr thrown;
  const auto lock = acquire(path, O_CREAT, timeout_ms, [&] {
    try {
      act();
    } catch (...) {
      thrown = std::current_exception();
    }
  });
  if (thrown) {
    std::rethrow_exception(thrown);
  }
  return lock.has_value();
}

std::optional<FileLock> FileLock::acquire(
  const std::string & path, int flags, int timeout_ms, const std::function<void()> & act) {
  while (true) {
    FileDescriptor fd = open_private_file(path, O_RDWR | flags, 0600);
    if (!fd && errno == ENOENT) {
      return std::nullopt;
    }
    if (!fd) {
      throw_errno("cannot open " + path);
    }
    bool is_current = false;
    const auto act_on_current = [&] {
      is_current = same_file(fd.get(), path);
      if (is_current) {
        act();
      }
    };
    if (!flock_within(fd.get(), timeout_ms, act_on_current)) {
      throw Error(
        ErrorCode::timeout, path + " has been locked for " + std::to_string(timeout_ms) +
                              " ms: " + describe_flock_owner(fd.get()));
    }
    FileLock lock(std::move(fd));
    if (is_current) {
      return lock;
    }
  }
}

}  // namespace manycore
