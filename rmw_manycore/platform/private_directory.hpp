// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// A directory that no other user can enter, held open, so that its path cannot be redirected
/// between check and use.
///
///   const auto directory = PrivateDirectory::open("/dev/shm/manycore-1000");
///   const FileDescriptor file = directory->open_file("domain-0", O_RDWR);
class PrivateDirectory {
public:
  /// Empty if there is no such directory. Throws Error{permission} if it belongs to another user,
  /// is open to others, or is a symbolic link or another kind of file.
  static std::optional<PrivateDirectory> open(const std::string & path);

  /// Opens a file of this user, closed to others and not a symbolic link, or creates one if `flags`
  /// say so. Invalid with errno set if open() fails. Throws Error{permission} for other files.
  FileDescriptor open_file(const std::string & name, int flags, mode_t mode = 0) const;
  /// Names of all entries, or of the subdirectories only.
  std::vector<std::string> entries() const { return names(false); }
  std::vector<std::string> directories() const { return names(true); }
  /// Unlinks an entry, never what it links to; false if that fails.
  bool remove(const std::string & name) const noexcept;

private:
  PrivateDirectory(FileDescriptor fd, std::string path);
  std::vector<std::string> names(bool only_directories) const;

  FileDescriptor fd_;
  std::string path_;
};

/// Opens a file by its path, as PrivateDirectory::open_file() does.
FileDescriptor open_private_file(const std::string & path, int flags, mode_t mode = 0);

/// Throws Error{permission} unless the open file `fd` belongs to this user.
void require_own_file(const FileDescriptor & fd, const std::string & path);

}  // namespace manycore
