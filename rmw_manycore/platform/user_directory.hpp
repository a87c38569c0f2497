// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace manycore {

/// The directory that this user's platforms lie in.
struct UserDirectory {
  std::string path;
  bool is_chosen = false;  ///< by MANYCORE_DIRECTORY: then it is the user's, to make and to remove

  /// /dev/shm/manycore-<uid>, which need not exist, or MANYCORE_DIRECTORY. Throws
  /// Error{invalid_argument|permission} when that is no private directory of this user.
  static UserDirectory from_environment();
  /// A directory that exists on its file system.
  std::string place() const { return is_chosen ? path : "/dev/shm"; }
};

/// Tries in `directory` what segments and pipes need of a file system, and leaves nothing there.
/// Throws Error{unsupported} that says what it cannot do.
void require_file_system_features(const std::string & directory);

}  // namespace manycore
