// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/file_users.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace manycore {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string & text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool maps_file_with(const fs::path & process, const std::string & beginning) {
  std::ifstream maps(process / "maps");
  for (std::string line; std::getline(maps, line);) {
    const size_t path = line.find('/');
    if (path != std::string::npos && line.compare(path, beginning.size(), beginning) == 0) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<FileUser> users_of_files_in(const std::string & directory) {
  std::error_code gone;  // the directory, or a process that ends meanwhile
  const std::string beginning = fs::canonical(directory, gone).string() + "/";
  std::vector<FileUser> users;
  for (fs::directory_iterator entry("/proc", gone), end; entry != end; entry.increment(gone)) {
    const fs::path & process = entry->path();
    if (is_number(process.filename()) && maps_file_with(process, beginning)) {
      const fs::path program = fs::read_symlink(process / "exe", gone);
      users.push_back({std::stoi(process.filename()), program.filename()});
    }
  }
  return users;
}

}  // namespace manycore
