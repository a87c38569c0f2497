// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <mutex>
#include <string>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A descriptor that survives being closed by the program. Programs that become daemons close all
/// descriptors, after which the number may refer to another file. Each use therefore checks that
/// the number still refers to this file, and otherwise opens the file again. Thread-safe.
class LastingDescriptor {
public:
  LastingDescriptor() = default;
  /// `flags` reopen `path`; without a path the file is not reopened.
  explicit LastingDescriptor(FileDescriptor fd, std::string path = {}, int flags = 0) noexcept;
  LastingDescriptor(LastingDescriptor && other) noexcept;
  LastingDescriptor & operator=(LastingDescriptor && other) noexcept;
  /// Does not close a number that refers to another file by now.
  ~LastingDescriptor();

  /// -1 with errno set if the descriptor is closed and the file was removed or replaced.
  int get() const noexcept;
  /// True if `path` names this file now. Needs no descriptor.
  bool is_at(const std::string & path) const noexcept;

private:
  bool is_own(int fd) const noexcept;

  std::string path_;
  int flags_ = 0;
  dev_t device_ = 0;  ///< identifies the file, together with inode_
  ino_t inode_ = 0;
  mutable std::atomic<int> fd_{-1};
  mutable std::mutex reopening_;
};

}  // namespace manycore
