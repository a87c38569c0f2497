// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/process_identity.hpp"

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

#include "platform/clock.hpp"
#include "platform/os_process.hpp"

namespace manycore {
namespace {

/// 0 if there is no such process, or no /proc.
uint64_t start_time_of(pid_t pid) {
  constexpr int fields_between = 19;  // state, field 3, to starttime, field 22
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  const size_t end_of_name = line.rfind(')');  // the name may contain any character
  if (end_of_name == std::string::npos) {
    return 0;
  }
  std::istringstream fields(line.substr(end_of_name + 1));
  std::string skipped;
  for (int i = 0; i < fields_between; ++i) {
    fields >> skipped;
  }
  uint64_t start_time = 0;
  fields >> start_time;
  return start_time;
}

}  // namespace

uint64_t own_pid_namespace() {
  struct stat status {};
  return stat("/proc/self/ns/pid", &status) == 0 ? status.st_ino : 0;
}

ProcessIdentity ProcessIdentity::own() { return of(getpid()); }

ProcessIdentity ProcessIdentity::of(pid_t pid) {
  return {pid, start_time_of(pid), own_pid_namespace()};
}

bool ProcessIdentity::is_of_this_pid_namespace() const {
  return pid_namespace != 0 && pid_namespace == own_pid_namespace();
}

void ProcessIdentity::wait_for_end(int timeout_ms) const {
  const FileDescriptor pidfd = open_pidfd(pid);
  if (pidfd && start_time_of(pid) == start_time) {
    const int64_t deadline_ns = monotonic_ns() + int64_t{timeout_ms} * (ns_per_s / 1000);
    pollfd end{pidfd.get(), POLLIN, 0};
    int left_ms = timeout_ms;
    while (poll(&end, 1, left_ms) < 0 && left_ms > 0) {  // interrupted by a signal handler
      left_ms = static_cast<int>((deadline_ns - monotonic_ns()) / (ns_per_s / 1000));
    }
  }
}

}  // namespace manycore
