// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A process that this one started and ends: killed and waited for by the destructor.
class ChildProcess {
public:
  ChildProcess() = default;
  /// Starts a program without inherited descriptors (errors still go to our standard error).
  /// Throws Error{system} when it cannot be started.
  explicit ChildProcess(const std::vector<std::string> & arguments);
  ChildProcess(ChildProcess && other) noexcept;
  ChildProcess & operator=(ChildProcess && other) noexcept;
  ~ChildProcess();

  pid_t pid() const noexcept { return pid_; }
  /// Tells whether there is no such process any more, which its pidfd proves.
  bool has_ended() const noexcept;
  /// Ends it, whatever it is doing.
  void kill() const noexcept;

private:
  pid_t pid_ = -1;
  FileDescriptor pidfd_;
};

/// Starts a thread that ends this process when `parent`, the process that started it, has ended.
void end_with_parent(pid_t parent);

}  // namespace manycore
