// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace manycore {

struct FileUser {
  pid_t pid;
  std::string name;  ///< of the executable
};

/// Processes that map a file of the directory. Those of other PID namespaces and of other users are
/// invisible.
std::vector<FileUser> users_of_files_in(const std::string & directory);

}  // namespace manycore
