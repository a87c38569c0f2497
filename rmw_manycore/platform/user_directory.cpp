// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/user_directory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "platform/error.hpp"
#include "platform/file_descriptor.hpp"
#include "platform/private_directory.hpp"

namespace manycore {
namespace {

constexpr const char * variable = "MANYCORE_DIRECTORY";

std::string quoted(const std::string & path) { return std::string(variable) + "='" + path + "' "; }

/// The command with the path as a shell takes it, in backquotes.
std::string command(const std::string & program, const std::string & path) {
  std::string word;
  for (const char c : path) {
    word += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return "`" + program + " '" + word + "'`";
}

void check_chosen(const std::string & path) {
  struct stat status {};
  if (path[0] != '/') {
    throw Error(ErrorCode::invalid_argument, quoted(path) + "is not an absolute path");
  }
  const FileDescriptor fd(open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!fd || fstat(fd.get(), &status) != 0) {
    const int cause = errno;
    throw Error(
      ErrorCode::invalid_argument,
      quoted(path) + "cannot be examined (" + std::strerror(cause) + "); " +
        (cause == ENOENT ? "create it: " + command("mkdir -p -m 700", path)
                         : "choose another one"));
  }
  if (!S_ISDIR(status.st_mode)) {
    throw Error(ErrorCode::invalid_argument, quoted(path) + "is not a directory");
  }
  if (status.st_uid != geteuid()) {
    throw Error(
      ErrorCode::permission, quoted(path) + "belongs to user " + std::to_string(status.st_uid) +
                               "; choose a directory of user " + std::to_string(geteuid()));
  }
  if ((status.st_mode & 077) != 0) {
    char mode[8];
    std::snprintf(mode, sizeof mode, "%o", status.st_mode & 0777u);
    // The sticky bit marks a directory that is meant for all users, as /tmp is.
    const bool is_for_all = (status.st_mode & S_ISVTX) != 0;
    throw Error(
      ErrorCode::permission,
      quoted(path) + "is open to other users (mode " + mode + "): " +
        (is_for_all ? command("mkdir -p -m 700", path + "/manycore") + ", and choose that"
                    : command("chmod 700", path)));
  }
  if (faccessat(AT_FDCWD, path.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) != 0) {
    throw Error(
      ErrorCode::permission, quoted(path) + "cannot be written to (" + std::strerror(errno) +
                               "); make it writable, or choose another one");
  }
}

/// The user may choose a link: the directory itself is checked and opened. Unchanged if there is
/// none.
std::string resolved(const char * path) {
  char real[PATH_MAX];
  return path[0] == '/' && realpath(path, real) != nullptr ? real : path;
}

void require_feature(bool there, const char * what, const std::string & directory) {
  if (!there) {
    throw Error(
      ErrorCode::unsupported, "the file system of " + directory + " cannot " + what + " (" +
                                std::strerror(errno) + "); choose a directory on a tmpfs for " +
                                variable);
  }
}

/// Path of a test file, removed on construction and destruction.
struct Probe {
  explicit Probe(const std::string & path_) : path(path_) { unlink(path.c_str()); }
  ~Probe() { unlink(path.c_str()); }
  Probe(const Probe &) = delete;
  Probe & operator=(const Probe &) = delete;
  const std::string path;
};

}  // namespace

UserDirectory UserDirectory::from_environment() {
  const char * const chosen = std::getenv(variable);
  if (chosen == nullptr || *chosen == 0) {
    const std::string path = "/dev/shm/manycore-" + std::to_string(geteuid());
    PrivateDirectory::open(path);  // refuses what another user put there
    return {path, false};
  }
  const std::string path = resolved(chosen);
  check_chosen(path);
  return {path, true};
}

void require_file_system_features(const std::string & directory) {
  constexpr off_t extent = 1 << 16;
  const Probe file(directory + "/probe");
  const Probe pipe(directory + "/probe.pipe");
  const FileDescriptor fd(open(file.path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  require_feature(static_cast<bool>(fd), "create files", directory);
  const int holes = FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE;
  require_feature(fallocate(fd.get(), 0, 0, extent) == 0, "reserve memory (fallocate)", directory);
  require_feature(
    fallocate(fd.get(), holes, 0, extent) == 0, "give memory back (fallocate)", directory);
  void * const mapped = mmap(nullptr, extent, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
  require_feature(mapped != MAP_FAILED, "share memory (mmap)", directory);
  munmap(mapped, extent);
  require_feature(mkfifo(pipe.path.c_str(), 0600) == 0, "hold pipes (mkfifo)", directory);
}

}  // namespace manycore
