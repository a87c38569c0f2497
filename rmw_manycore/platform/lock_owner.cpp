// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/lock_owner.hpp"

#include <fstream>
#include <optional>

namespace manycore {
namespace {

struct ThreadStatus {
  std::string process;  ///< process id
  std::string name;
  char state = '?';  ///< as in proc(5): R, S, D, T, t, Z, X
};

/// Empty when there is no such thread.
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
    }
  }
  return status.process.empty() ? std::nullopt : std::optional<ThreadStatus>(status);
}

}  // namespace

std::string describe_lock_owner(pid_t thread) {
  if (thread == 0) {
    return "no process holds it any more; try again";
  }
  const std::optional<ThreadStatus> owner = status_of(thread);
  if (!owner) {
    return "its owner, thread " + std::to_string(thread) +
           ", does not exist here: it runs in another container, or the lock is damaged; stop the "
           "platform's nodes and run 'manycore clean'";
  }
  const std::string holds = "process " + owner->process + " (" + owner->name + ") holds it and is ";
  if (owner->state == 'T') {
    return holds + "stopped; continue it (kill -CONT " + owner->process + ") or end it";
  }
  if (owner->state == 't') {
    return holds + "stopped by a debugger; continue it or end it";
  }
  return holds + "not stopped (state " + owner->state + "); try again, or end it if it hangs";
}

}  // namespace manycore
