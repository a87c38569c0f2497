// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace manycore {

/// The directory that holds this user's platforms.
struct UserDirectory {
  std::string path;
  bool is_chosen = false;  ///< by MANYCORE_DIRECTORY: the user creates and removes it

  /// MANYCORE_DIRECTORY, or /dev/shm/manycore-<uid>, which need not exist. Throws
  /// Error{invalid_argument|permission} if the directory is not private to this user.
  static UserDirectory from_environment();
  /// An existing directory on the same file system.
  std::string place() const { return is_chosen ? path : "/dev/shm"; }
};

/// Tests in `directory` the file system features that segments and pipes need, and leaves no files
/// there. Throws Error{unsupported} naming the missing feature.
void require_file_system_features(const std::string & directory);

}  // namespace manycore
