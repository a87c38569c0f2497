// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A descriptor that becomes readable when `pid` ends; empty when there is no such process.
FileDescriptor open_pidfd(pid_t pid);

/// Pins the calling thread (and threads it starts later) to one host CPU; false when not allowed.
bool pin_to_cpu(int host_cpu) noexcept;

/// Name of this program, for labels: the script of an interpreter, else the executable.
std::string program_name();

/// Starts `arguments` as a daemon (own process group, no inherited descriptors) and waits until
/// it reports readiness by exiting its parent half; returns that exit status, -1 when not started.
int spawn_daemon(const std::vector<std::string> & arguments);

/// Called by a daemon at its start: forks, and lets the parent half exit once the child has called
/// the returned object's ready(), or with status 1 when the child dies before that.
class Daemon {
public:
  static Daemon detach();
  void ready() noexcept;

private:
  explicit Daemon(FileDescriptor status) : status_(std::move(status)) {}
  FileDescriptor status_;
};

}  // namespace manycore
