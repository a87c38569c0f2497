// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/lock_owner.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "platform/process_identity.hpp"

namespace manycore {
namespace {

struct ThreadStatus {
  std::string process;  ///< process id
  std::string name;
  char state = '?';     ///< as in proc(5): R, S, D, T, t, Z, X
  uint64_t sleeps = 0;  ///< how often it has given up its CPU to wait
};

/// Empty if there is no such thread.
std::optional<ThreadStatus> status_of(pid_t thread) {
  std::ifstream file("/proc/" + std::to_string(thread) + "/status");
  ThreadStatus status;
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(":\t");
    const std::string key = line.substr(0, colon);
    const std::string value = colon == std::string::npos ? "" : line.substr(colon + 2);
    if (key == "Name") {
      status.name = value;
    } else if (key == "State" && !value.empty()) {
      status.state = value[0];
    } else if (key == "Tgid") {
      status.process = value;
    } else if (key == "voluntary_ctxt_switches") {
      status.sleeps = std::strtoull(value.c_str(), nullptr, 10);
    }
  }
  return status.process.empty() ? std::nullopt : std::optional<ThreadStatus>(status);
}

/// Name of a file in /proc/locks: "fe:00:2149051".
std::string name_in_locks(const struct stat & file) {
  char device[32];
  std::snprintf(device, sizeof device, "%02x:%02x:", major(file.st_dev), minor(file.st_dev));
  return device + std::to_string(file.st_ino);
}

/// Process that holds flock() on a file. Empty if there is none, or if it is in another PID
/// namespace.
std::optional<pid_t> flock_owner_of(const std::string & file) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);  // "2: FLOCK  ADVISORY  WRITE 6936 fe:00:2149051 0 EOF"
    std::string number, kind, is_advisory, access, name;
    pid_t process = 0;
    words >> number >> kind >> is_advisory >> access >> process >> name;
    if (words && kind == "FLOCK" && name == file) {
      return process;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string describe_lock_owner(const LockOwner & owner) {
  if (owner.thread == 0) {
    return "its owner has just released it; try again; if that does not help, it is damaged: stop "
           "the platform's nodes and run 'manycore clean'";
  }
  const std::string thread = std::to_string(owner.thread);
  if (owner.pid_namespace != own_pid_namespace()) {
    return "its owner runs in another container, as thread " + thread +
           "; continue or end it there";
  }
  const std::optional<ThreadStatus> status = status_of(owner.thread);
  if (!status) {
    return "its owner, thread " + thread + ", has just ended; try again";
  }
  const std::string holds =
    "process " + status->process + " (" + status->name + ") holds it and is ";
  if (status->state == 'T') {
    return holds + "stopped; continue it (`kill -CONT " + status->process + "`) or end it";
  }
  if (status->state == 't') {
    return holds + "stopped by a debugger; continue it or end it";
  }
  return holds + "not stopped (state " + status->state +
         "); try again, or end it if it hangs or its cgroup is frozen";
}

bool LockOwnerWatch::may_unlock(const LockOwner & owner) {
  if (owner.thread == 0) {
    return true;
  }
  const auto status = owner.pid_namespace == own_pid_namespace() ? status_of(owner.thread)
                                                                 : std::optional<ThreadStatus>();
  if (!status || status->state == 'T' || status->state == 't') {
    return false;
  }
  // A frozen thread sleeps (S), or waits for a disk (D). Owners of a lock do so briefly at most.
  const bool has_slept_on =
    status->state != 'R' && thread_ == owner.thread && sleeps_ == status->sleeps;
  thread_ = owner.thread;
  sleeps_ = status->sleeps;
  return !has_slept_on;
}

std::string describe_flock_owner(int fd) {
  struct stat file {};
  const bool is_open = fstat(fd, &file) == 0;
  const auto owner = is_open ? flock_owner_of(name_in_locks(file)) : std::nullopt;
  return owner ? describe_lock_owner({*owner, own_pid_namespace()})
               : "its owner is not visible here: it has just released it, or runs in another "
                 "container; try again";
}

}  // namespace manycore
