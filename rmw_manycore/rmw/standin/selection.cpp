// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Stand-in for librmw_fastrtps_cpp.so. Loads librmw_manycore.so, and hands a program over to Fast
// DDS if its RMW_IMPLEMENTATION is not rmw_manycore: the program has then inherited a library path
// made for another one. See docs/design/substitution.md.

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
// Exit status of rcl when the middleware does not match RMW_IMPLEMENTATION.
constexpr int mismatch_status = 102;

std::string variable(const char * name) {
  const char * value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// True if this library was loaded before main(), false if a running program opened it: only in the
/// first case it is in the scope of the program's own libraries.
bool is_loaded_with_program() {
  void * program = dlopen(nullptr, RTLD_LAZY);
  return program != nullptr && dlsym(program, "rmw_manycore_standin") != nullptr;
}

fs::path own_directory() {
  Dl_info info;
  const bool is_known = dladdr(&rmw_manycore_standin, &info) != 0;
  return is_known ? fs::path(info.dli_fname).parent_path() : fs::path();
}

/// The loader's search path without `directory`; nothing if `directory` is not in it.
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

/// Restarts the program with another library path. Returns on failure.
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
    "rmw_manycore: RMW_IMPLEMENTATION is %s, but rmw_manycore was loaded in place of Fast DDS; "
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
