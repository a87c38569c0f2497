// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <mutex>
#include <string>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A descriptor that a program may close although it is ours: programs that become daemons close
/// all, and the number may then be another file's. So each use asks whether it still is this
/// file's, and opens the file again where it is not. Thread-safe.
class LastingDescriptor {
public:
  LastingDescriptor() = default;
  /// `flags` are those to open `path` with again; what has no path stays closed.
  explicit LastingDescriptor(FileDescriptor fd, std::string path = {}, int flags = 0) noexcept;
  LastingDescriptor(LastingDescriptor && other) noexcept;
  LastingDescriptor & operator=(LastingDescriptor && other) noexcept;
  /// Leaves a number alone that is another file's.
  ~LastingDescriptor();

  /// -1 with errno when the file is closed and cannot be opened again, as it is gone or replaced.
  int get() const noexcept;
  /// Whether `path` names this file now. Needs no descriptor.
  bool is_at(const std::string & path) const noexcept;

private:
  bool is_own(int fd) const noexcept;

  std::string path_;
  int flags_ = 0;
  dev_t device_ = 0;  ///< with inode_: which file it is
  ino_t inode_ = 0;
  mutable std::atomic<int> fd_{-1};
  mutable std::mutex reopening_;
};

}  // namespace manycore
