// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <utility>

#include "platform/error.hpp"
#include "platform/os_process.hpp"
#include "waiting.hpp"

using manycore::FileDescriptor;

namespace {

constexpr char role_marker[] = "--role";

/// Filled before main() by the roles at file scope.
std::map<std::string, Role::Play> & roles() {
  static std::map<std::string, Role::Play> all;
  return all;
}

struct Ends {
  FileDescriptor reader;
  FileDescriptor writer;
};

Ends make_pipe() {
  int fds[2];
  if (pipe2(fds, O_CLOEXEC) != 0) {
    manycore::throw_errno("cannot create a pipe");
  }
  return {FileDescriptor(fds[0]), FileDescriptor(fds[1])};
}

pid_t spawn_role(const std::string & role, const Arguments & arguments, int in, int out) {
  std::string program = "/proc/self/exe";
  std::vector<std::string> words{program, role_marker, role};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char *> argv;
  for (std::string & word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::runtime_error("cannot start role " + role);
  }
  return pid;
}

}  // namespace

Lines::Lines(FileDescriptor in, FileDescriptor out) : in_(std::move(in)), out_(std::move(out)) {}

void Lines::say(const std::string & line) {
  const std::string text = line + "\n";
  if (write(out_.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error("the other side has ended before '" + line + "' was sent");
  }
}

bool Lines::has_news(int timeout_ms) const {
  pollfd fd{in_.get(), POLLIN, 0};
  return unread_.find('\n') != std::string::npos || poll(&fd, 1, timeout_ms) > 0;
}

std::string Lines::hear() {
  size_t end = unread_.find('\n');
  while (end == std::string::npos) {
    char buffer[4096];
    if (!has_news(timeout_s * 1000)) {
      throw std::runtime_error("no line within " + std::to_string(timeout_s) + " s");
    }
    const ssize_t got = read(in_.get(), buffer, sizeof buffer);
    if (got <= 0) {
      throw std::runtime_error("the other side has ended; its last output: '" + unread_ + "'");
    }
    unread_.append(buffer, static_cast<size_t>(got));
    end = unread_.find('\n');
  }
  const std::string line = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return line;
}

void Lines::expect(const std::string & expected) {
  const std::string heard = hear();
  if (heard != expected) {
    throw std::runtime_error("expected '" + expected + "', received '" + heard + "'");
  }
}

Role::Role(const char * name, Play play) { roles()[name] = std::move(play); }

bool Role::play(int argc, char ** argv, int & status) {
  if (argc < 3 || std::string(argv[1]) != role_marker) {
    return false;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that crashes leaves no child behind
  Lines test{FileDescriptor(STDIN_FILENO), FileDescriptor(STDOUT_FILENO)};
  try {
    roles().at(argv[2])(test, Arguments(argv + 3, argv + argc));
    status = 0;
  } catch (const std::exception & error) {
    test.say(std::string("error: ") + error.what());
    status = 1;
  }
  return true;
}

Child::Child(const std::string & role, const Arguments & arguments)
: Child(start(role, arguments)) {}

Child Child::start(const std::string & role, const Arguments & arguments) {
  Ends to_child = make_pipe();
  Ends from_child = make_pipe();
  const pid_t pid = spawn_role(role, arguments, to_child.reader.get(), from_child.writer.get());
  return {pid, Lines(std::move(from_child.reader), std::move(to_child.writer))};
}

Child::Child(Child && other) noexcept
: pid_(std::exchange(other.pid_, -1)), lines_(std::move(other.lines_)) {}

Child::~Child() { kill(); }

void Child::stop() {
  ::kill(pid_, SIGSTOP);
  wait_until_stopped();
}

void Child::wait_until_stopped() {
  int status = 0;
  waitpid(pid_, &status, WUNTRACED);
  if (!WIFSTOPPED(status)) {
    pid_ = -1;  // the pid may belong to another process from now on
    throw std::runtime_error("the process has ended instead of stopping");
  }
}

void Child::resume() { ::kill(pid_, SIGCONT); }

void Child::kill() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
}

int Child::wait() {
  const FileDescriptor pidfd = manycore::open_pidfd(pid_);
  pollfd fd{pidfd.get(), POLLIN, 0};
  if (poll(&fd, 1, timeout_s * 1000) != 1) {
    throw std::runtime_error("process " + std::to_string(pid_) + " does not end");
  }
  int status = 0;
  waitpid(std::exchange(pid_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}
