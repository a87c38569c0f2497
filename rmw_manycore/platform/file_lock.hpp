// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// Exclusive lock of a whole file (flock), held during its lifetime. The holder may unlink the
/// file: acquire() checks that the locked file is still the one at `path`.
class FileLock {
public:
  /// Waits at most `timeout_ms`; throws Error{timeout} naming the file and its owner. Empty if the
  /// directory of the file is missing, because its last user has just removed it.
  static std::optional<FileLock> acquire(const std::string & path, int timeout_ms);
  FileLock(FileLock &&) = default;
  FileLock & operator=(FileLock &&) = default;
  /// Unlocks before closing: a child of fork() may share the open file, which holds the lock.
  ~FileLock();

private:
  explicit FileLock(FileDescriptor fd) : fd_(std::move(fd)) {}
  FileDescriptor fd_;
};

}  // namespace manycore
