// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <thread>
#include <utility>

#include "platform/error.hpp"
#include "platform/os_process.hpp"

extern char ** environ;

namespace manycore {
namespace {

/// Settings of a child that must not receive the terminal's Ctrl-C nor keep this process's
/// descriptors open.
class SpawnSettings {
public:
  SpawnSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions, 0, 1);
    posix_spawn_file_actions_addclosefrom_np(&actions, 3);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings &) = delete;
  SpawnSettings & operator=(const SpawnSettings &) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

bool is_readable(int fd, int timeout_ms) noexcept {
  pollfd watched{fd, POLLIN, 0};
  return poll(&watched, 1, timeout_ms) > 0;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string> & arguments) {
  std::vector<char *> argv;
  for (const std::string & argument : arguments) {
    argv.push_back(const_cast<char *>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const SpawnSettings settings;
  const int error =
    posix_spawn(&pid_, argv[0], &settings.actions, &settings.attributes, argv.data(), environ);
  if (error != 0) {
    pid_ = -1;
    errno = error;
    throw_errno("cannot start " + arguments[0]);
  }
  pidfd_ = open_pidfd(pid_);
}

ChildProcess::ChildProcess(ChildProcess && other) noexcept { *this = std::move(other); }

ChildProcess & ChildProcess::operator=(ChildProcess && other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(pidfd_, other.pidfd_);
  return *this;
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) {
    return;
  }
  kill();
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool ChildProcess::has_ended() const noexcept {
  return pid_ < 0 || !pidfd_ || is_readable(pidfd_.get(), 0);
}

void ChildProcess::kill() const noexcept {
  // not reaped yet, so the pid cannot belong to another process
  ::kill(pid_, SIGKILL);
}

void end_with_parent(pid_t parent) {
  FileDescriptor pidfd = open_pidfd(parent);
  if (getppid() != parent || !pidfd) {
    _exit(0);
  }
  std::thread([fd = std::move(pidfd)] {
    while (!is_readable(fd.get(), -1)) {
    }
    _exit(0);
  }).detach();
}

}  // namespace manycore
