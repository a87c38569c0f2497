// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/cleaning.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <optional>

#include "platform/file_users.hpp"
#include "transport/lifecycle/lifecycle.hpp"

namespace manycore {
namespace {

/// Whether any process but receive threads lives; empty if the lifelines are damaged.
std::optional<bool> has_members(const PlatformPaths & paths) {
  struct stat file {};
  if (lstat(paths.alive().c_str(), &file) != 0 && errno == ENOENT) {
    return false;
  }
  if (!S_ISREG(file.st_mode)) {
    return std::nullopt;
  }
  try {
    const Lifelines alive = Lifelines::open(paths.alive());
    bool found = alive.is_held(configurator_line);
    for (uint32_t slot = 0; slot < process_capacity && !found; ++slot) {
      found = alive.is_held(slot);
    }
    return found;
  } catch (const Error & error) {
    if (error.code() != ErrorCode::corrupt) {
      throw;
    }
    return std::nullopt;
  }
}

/// "python3 (4711), talker (4712)"; receive threads end with their platform.
std::string visible_members(const PlatformPaths & paths) {
  std::string names;
  for (const FileUser & user : users_of_files_in(paths.directory)) {
    if (user.name != "manycore_receive_thread") {
      names += (names.empty() ? "" : ", ") + user.name + " (" + std::to_string(user.pid) + ")";
    }
  }
  return names;
}

void require_unused(const PlatformPaths & paths, const std::string & platform, bool force) {
  const std::optional<bool> is_used = force ? std::nullopt : has_members(paths);
  if (is_used.has_value() && !*is_used) {
    return;
  }
  const std::string members = visible_members(paths);
  if (!members.empty()) {
    throw PlatformInUse("platform '" + platform + "' is alive; stop its nodes first: " + members);
  }
  if (is_used.has_value()) {
    throw PlatformInUse(
      "platform '" + platform +
      "' is alive, but no process that is visible here uses it; stop its nodes in other "
      "containers, then run 'manycore clean --force " +
      platform + "'");
  }
}

}  // namespace

std::vector<std::string> clean_platform(const std::string & platform, bool force) {
  const PlatformPaths paths = PlatformPaths::of(platform);
  std::vector<std::string> removed;
  std::error_code reason;
  under_join_lock(paths, [&] {
    require_unused(paths, platform, force);
    removed = remove_platform(paths);
    // What is left are no files of a platform, e.g. a directory in the place of one.
    if (std::filesystem::remove_all(paths.directory, reason) > 0 && !reason) {
      removed.push_back(paths.directory);
    }
  });
  if (reason) {
    throw Error(
      ErrorCode::system, "cannot remove " + paths.directory + ": " + reason.message() +
                           "; remove it by hand once its nodes are stopped");
  }
  return removed;
}

}  // namespace manycore
