// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/private_directory.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "platform/error.hpp"

namespace manycore {
namespace {

bool is_private(const struct stat & status) {
  return status.st_uid == geteuid() && (status.st_mode & 077) == 0;
}

struct stat status_of(const FileDescriptor & fd, const std::string & path) {
  struct stat status {};
  if (fstat(fd.get(), &status) != 0) {
    throw_errno("cannot examine " + path);
  }
  return status;
}

Error not_private(const std::string & path, const char * kind) {
  return Error(
    ErrorCode::permission, path + " is not a private " + kind +
                             " of this user; remove it (or ask its owner to), then try again");
}

}  // namespace

PrivateDirectory::PrivateDirectory(FileDescriptor fd, std::string path)
: fd_(std::move(fd)), path_(std::move(path)) {}

std::optional<PrivateDirectory> PrivateDirectory::open(const std::string & path) {
  FileDescriptor fd(::open(path.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
  if (!fd && errno == ENOENT) {
    return std::nullopt;
  }
  if (!fd) {
    throw_errno("cannot open " + path);
  }
  const struct stat status = status_of(fd, path);
  if (!S_ISDIR(status.st_mode) || !is_private(status)) {
    throw not_private(path, "directory");
  }
  return PrivateDirectory(std::move(fd), path);
}

FileDescriptor PrivateDirectory::open_file(const std::string & name, int flags, mode_t mode) const {
  FileDescriptor file(openat(fd_.get(), name.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, mode));
  const std::string path = path_ + "/" + name;
  const bool is_link = !file && errno == ELOOP;
  if (is_link || (file && !is_private(status_of(file, path)))) {
    throw not_private(path, "file");
  }
  return file;
}

std::vector<std::string> PrivateDirectory::names(bool only_directories) const {
  const int again = openat(fd_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, int (*)(DIR *)> handle(
    again < 0 ? nullptr : fdopendir(again), closedir);
  if (!handle) {
    throw_errno("cannot list " + path_);
  }
  std::vector<std::string> names;
  while (const dirent * const entry = readdir(handle.get())) {
    const bool is_listed = !only_directories || entry->d_type == DT_DIR;
    if (
      is_listed && std::strcmp(entry->d_name, ".") != 0 && std::strcmp(entry->d_name, "..") != 0) {
      names.emplace_back(entry->d_name);
    }
  }
  return names;
}

bool PrivateDirectory::remove(const std::string & name) const noexcept {
  return unlinkat(fd_.get(), name.c_str(), 0) == 0;
}

FileDescriptor open_private_file(const std::string & path, int flags, mode_t mode) {
  const size_t slash = path.rfind('/');
  const auto directory = PrivateDirectory::open(path.substr(0, slash));
  if (!directory) {
    errno = ENOENT;
    return {};
  }
  return directory->open_file(path.substr(slash + 1), flags, mode);
}

void require_own_file(const FileDescriptor & fd, const std::string & path) {
  if (status_of(fd, path).st_uid != geteuid()) {
    throw Error(ErrorCode::permission, path + " belongs to another user");
  }
}

}  // namespace manycore
