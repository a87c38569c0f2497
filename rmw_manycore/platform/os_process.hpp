// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A pidfd, which becomes readable when `pid` ends; empty if there is no such process.
FileDescriptor open_pidfd(pid_t pid);

/// Sends SIGKILL to the process of a pidfd; no other one can have taken its id.
void kill_process(const FileDescriptor & pidfd) noexcept;

/// Pins the calling thread, and threads that it starts later, to one host CPU. False if not
/// permitted.
bool pin_to_cpu(int host_cpu) noexcept;

/// Schedules the calling thread with SCHED_FIFO; false if this user may not. `priority`: 1 to 99.
bool run_in_real_time(int priority) noexcept;

/// Name of this program, for labels: the script or module of an interpreter, the docstring of its
/// command, otherwise the executable.
std::string program_name();

/// Starts `arguments` as a daemon (own process group, no inherited descriptors) and waits until its
/// parent half exits, which reports readiness. Returns the exit status. Throws if the program
/// cannot be started; one that is being installed is waited for, for a second.
int spawn_daemon(const std::vector<std::string> & arguments);

/// Called by a daemon at its start: forks, and keeps the parent half until the child calls ready()
/// on the returned object. The parent half exits with status 0 then, and with status 1 if the child
/// dies before.
class Daemon {
public:
  static Daemon detach();
  void ready() noexcept;

private:
  explicit Daemon(FileDescriptor status) : status_(std::move(status)) {}
  FileDescriptor status_;
};

}  // namespace manycore
