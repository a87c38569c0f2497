// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// Exclusive lock of a whole file (flock), held during its lifetime. The kernel releases it after
/// the last thread of a killed holder has ended. The holder may unlink the file: the lock is that
/// of the file which is at `path` by then.
class FileLock {
public:
  /// Creates the file if it is missing; see open_private_file(). Waits at most `timeout_ms`, in
  /// which this process can run; throws Error{timeout} naming the file and its owner. Empty if the
  /// directory of the file is missing, because its last user has just removed it.
  static std::optional<FileLock> acquire(const std::string & path, int timeout_ms);
  /// As acquire(), but empty if the file itself is missing.
  static std::optional<FileLock> acquire_existing(const std::string & path, int timeout_ms);
  /// As acquire(), and calls `act` while the file is locked, on the thread that waited for it; see
  /// flock_within(). Passes on what `act` throws. False if the directory is missing.
  static bool run(const std::string & path, int timeout_ms, const std::function<void()> & act);
  FileLock(FileLock &&) = default;
  FileLock & operator=(FileLock &&) = default;
  /// Unlocks before closing: a child of fork() may share the open file, which holds the lock.
  ~FileLock();

private:
  explicit FileLock(FileDescriptor fd) : fd_(std::move(fd)) {}
  static std::optional<FileLock> acquire(
    const std::string & path, int flags, int timeout_ms, const std::function<void()> & act);
  FileDescriptor fd_;
};

}  // namespace manycore
