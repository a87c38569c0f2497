// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The stand-in for librmw_fastrtps_cpp.so. It brings librmw_manycore.so with it, and leaves a
// program to Fast DDS whose RMW_IMPLEMENTATION is not rmw_manycore: that program has inherited a
// search path made for another one. See docs/design/substitution.md.

#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

namespace fs = std::filesystem;

extern "C" __attribute__((visibility("default"))) const char rmw_manycore_standin = 0;

namespace {

constexpr char library_path_variable[] = "LD_LIBRARY_PATH";
constexpr int mismatch_status = 102;  // rcl's, for a middleware other than RMW_IMPLEMENTATION

std::string variable(const char * name) {
  const char * value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Tell a library that was loaded before main() from one that a running program has opened: only
/// the first is in the scope of the program's own libraries.
bool is_loaded_with_program() {
  void * program = dlopen(nullptr, RTLD_LAZY);
  return program != nullptr && dlsym(program, "rmw_manycore_standin") != nullptr;
}

fs::path own_directory() {
  Dl_info info;
  const bool is_known = dladdr(&rmw_manycore_standin, &info) != 0;
  return is_known ? fs::path(info.dli_fname).parent_path() : fs::path();
}

/// Return the loader's search path without a directory, unless that is not in it.
std::optional<std::string> library_path_without(const fs::path & directory) {
  std::istringstream before(variable(library_path_variable));
  std::string after;
  bool is_found = false;
  for (std::string entry; std::getline(before, entry, ':');) {
    std::error_code ignored;
    if (fs::equivalent(entry, directory, ignored)) {
      is_found = true;
    } else {
      after += (after.empty() ? "" : ":") + entry;
    }
  }
  return is_found ? std::optional(after) : std::nullopt;
}

/// Start the program anew with another search path; returns if that fails.
void restart(char ** argv, const std::string & library_path) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error && setenv(library_path_variable, library_path.c_str(), 1) == 0) {
    execv(program.c_str(), argv);
  }
}

[[noreturn]] void refuse(const std::string & wanted, const fs::path & directory) {
  std::fprintf(
    stderr,
    "rmw_manycore: RMW_IMPLEMENTATION is %s, but rmw_manycore was loaded in the place of Fast DDS; "
    "start the program without %s in %s\n",
    wanted.c_str(), directory.c_str(), library_path_variable);
  std::exit(mismatch_status);
}

__attribute__((constructor)) void heed_selection(int /*argc*/, char ** argv) {
  const std::string wanted = variable("RMW_IMPLEMENTATION");
  if (wanted == "rmw_manycore") {
    return;
  }
  const fs::path directory = own_directory();
  const auto library_path = library_path_without(directory);
  if (library_path && is_loaded_with_program()) {
    restart(argv, *library_path);
  }
  if (!wanted.empty()) {
    refuse(wanted, directory);
  }
}

}  // namespace
