// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Refuses to be loaded beside another distribution of ROS 2 than the one it was built for: their
// structures differ, so that calls would corrupt memory.

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "rmw/init.h"

namespace rmw_manycore {
namespace {

/// As that of rcl when the middleware does not match RMW_IMPLEMENTATION.
constexpr int mismatch_status = 102;

/// Prefix of the rmw package that this process has loaded; empty if it is not known.
std::string prefix_of_rmw() {
  Dl_info info;
  const auto * const function = reinterpret_cast<const void *>(&rmw_get_zero_initialized_context);
  const bool is_known = dladdr(function, &info) != 0 && info.dli_fname != nullptr;
  const std::string library = is_known ? info.dli_fname : "";
  const size_t end = library.rfind("/lib/");
  return end == std::string::npos ? "" : library.substr(0, end);
}

/// Version in package.xml; empty if there is none.
std::string version_of_rmw(const std::string & prefix) {
  std::ifstream file(prefix + "/share/rmw/package.xml");
  const std::string begin = "<version>";
  for (std::string line; std::getline(file, line);) {
    if (const size_t at = line.find(begin); at != std::string::npos) {
      const size_t first = at + begin.size();
      return line.substr(first, line.find('<', first) - first);
    }
  }
  return "";
}

__attribute__((constructor)) void require_own_distribution() {
  const std::string prefix = prefix_of_rmw();
  const std::string version = version_of_rmw(prefix) + ".";
  const std::string own = RMW_OF_DISTRIBUTION;
  if (version != "." && version.rfind(own + ".", 0) != 0) {
    std::fprintf(
      stderr,
      "rmw_manycore: built for ROS 2 %s (rmw %s), but %s has rmw %s; install rmw_manycore for that "
      "distribution, or use an environment of %s alone\n",
      MANYCORE_ROS_DISTRIBUTION, own.c_str(), prefix.c_str(),
      version.substr(0, version.size() - 1).c_str(), MANYCORE_ROS_DISTRIBUTION);
    std::exit(mismatch_status);
  }
}

}  // namespace
}  // namespace rmw_manycore
