// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// One file of byte locks (fcntl): the kernel drops a process's locks when it dies, whatever killed
/// it, so a held byte proves life and a free one proves death, with no doubt about reused pids.
/// A process must open the file once only: closing any descriptor of it drops its locks. Copies
/// share one descriptor, which is closed with the last of them.
class ByteLocks {
public:
  static void create(const std::string & path);
  static ByteLocks open(const std::string & path);

  /// False when another process holds the byte.
  bool try_lock(uint32_t byte) const;
  void unlock(uint32_t byte) const noexcept;
  /// True when any process holds the byte.
  bool is_held(uint32_t byte) const;
  bool is_any_held() const;
  /// True when this process holds a byte.
  bool holds_any() const;
  /// False once the file was removed, or replaced by another one.
  bool is_current() const noexcept;

private:
  struct Opened {
    FileDescriptor fd;
    std::string path;
    std::mutex mutex;
    std::set<uint32_t> bytes;  ///< held by this process: the kernel does not report them to it
  };

  explicit ByteLocks(std::shared_ptr<Opened> opened) : opened_(std::move(opened)) {}
  /// True when another process holds a byte in [first, first + count); count 0 = to the end.
  bool is_held_elsewhere(uint32_t first, uint32_t count) const;

  std::shared_ptr<Opened> opened_;
};

/// Exclusive lock of a whole file (flock), held while alive. The file may be unlinked by its
/// holder; acquiring checks that the locked file is still the one at `path`.
class FileLock {
public:
  /// Waits at most `timeout_ms`; throws Error{timeout} naming the file. Empty when the file's
  /// directory is missing (its last user has just removed it).
  static std::optional<FileLock> acquire(const std::string & path, int timeout_ms);

private:
  explicit FileLock(FileDescriptor fd) : fd_(std::move(fd)) {}
  FileDescriptor fd_;
};

}  // namespace manycore
