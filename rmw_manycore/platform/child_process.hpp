// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A child process owned by this process: the destructor kills it and waits for it.
class ChildProcess {
public:
  ChildProcess() = default;
  /// Starts a program without inherited descriptors, except standard error. Throws Error{system} if
  /// it cannot be started.
  explicit ChildProcess(const std::vector<std::string> & arguments);
  ChildProcess(ChildProcess && other) noexcept;
  ChildProcess & operator=(ChildProcess && other) noexcept;
  ~ChildProcess();

  pid_t pid() const noexcept { return pid_; }
  /// True if the process has ended, as its pidfd proves.
  bool has_ended() const noexcept;
  /// Sends SIGKILL.
  void kill() const noexcept;

private:
  pid_t pid_ = -1;
  FileDescriptor pidfd_;
};

/// Starts a thread that ends this process when `parent`, its parent process, has ended.
void end_with_parent(pid_t parent);

}  // namespace manycore
