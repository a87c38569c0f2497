// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/os_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>

#include "platform/error.hpp"
#include "platform/wall_sleep.hpp"

extern char ** environ;

namespace manycore {
namespace {

// An installer writes the program (ETXTBSY), or a fork of it has not yet closed the file.
constexpr int busy_tries = 100;
constexpr auto busy_pause = std::chrono::milliseconds(10);

std::string base_name(const std::string & path) { return path.substr(path.rfind('/') + 1); }

std::vector<std::string> command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) {
    words.push_back(word);
  }
  return words;
}

/// First line of that of Python code, in three double quotes.
std::string docstring(const std::string & code) {
  const std::string quotes = "\"\"\"";
  const size_t end = code.find(quotes, quotes.size());
  const bool begins = code.compare(0, quotes.size(), quotes) == 0 && end != std::string::npos;
  const std::string text = begins ? code.substr(quotes.size(), end - quotes.size()) : "";
  const size_t first = std::min(text.find_first_not_of(" \t\n"), text.size());
  return text.substr(first, text.find('\n', first) - first);
}

}  // namespace

FileDescriptor open_pidfd(pid_t pid) {
  FileDescriptor fd(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
  if (!fd && errno != ESRCH && errno != EINVAL) {
    throw_errno("cannot watch process " + std::to_string(pid));
  }
  return fd;
}

void kill_process(const FileDescriptor & pidfd) noexcept {
  syscall(SYS_pidfd_send_signal, pidfd.get(), SIGKILL, nullptr, 0);
}

bool pin_to_cpu(int host_cpu) noexcept {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<size_t>(host_cpu), &cpus);
  return sched_setaffinity(0, sizeof cpus, &cpus) == 0;
}

bool run_in_real_time(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

std::string program_name() {
  const std::vector<std::string> words = command_line();
  if (words.empty()) {
    return "?";
  }
  const std::string executable = base_name(words[0]);
  if (executable.rfind("python", 0) != 0) {
    return executable;
  }
  for (size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "-m" && i + 1 < words.size()) {
      return words[i + 1];
    }
    if (words[i] == "-c" && i + 1 < words.size()) {
      const std::string title = docstring(words[i + 1]);
      return title.empty() ? executable + " -c" : title;
    }
    if (words[i][0] != '-') {
      const std::string script = base_name(words[i]);
      // startup/rmw_manycore_program.py runs a module of this project
      const bool runs_module = script == "rmw_manycore_program.py" && i + 1 < words.size();
      return runs_module ? words[i + 1] : script;
    }
  }
  return executable;
}

int spawn_daemon(const std::vector<std::string> & arguments) {
  std::vector<char *> argv;
  for (const std::string & argument : arguments) {
    argv.push_back(const_cast<char *>(argument.c_str()));
  }
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&actions, 0, 1);
  posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t all;
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  pid_t pid = -1;
  int error = ETXTBSY;
  for (int tries = 0; error == ETXTBSY && tries < busy_tries; ++tries) {
    if (tries > 0) {
      wall_sleep_for(busy_pause);
    }
    error = posix_spawn(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  }
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    errno = error;
    throw_errno("cannot start " + arguments[0]);
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) {
      return 0;  // the program ignores SIGCHLD, so its children leave no status
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

namespace {

/// Resets attributes that a daemon would inherit for good from the program that happened to start
/// it. Those that need privileges stay as they are.
void shed_inherited_attributes() noexcept {
  const int moved = chdir("/");
  static_cast<void>(moved);
  umask(077);
  const sched_param normal{};
  sched_setscheduler(0, SCHED_OTHER, &normal);
  setpriority(PRIO_PROCESS, 0, 0);
  for (const auto resource : {RLIMIT_CPU, RLIMIT_FSIZE, RLIMIT_DATA, RLIMIT_AS, RLIMIT_NOFILE}) {
    rlimit limit{};
    getrlimit(resource, &limit);
    limit.rlim_cur = limit.rlim_max;
    setrlimit(resource, &limit);
  }
}

}  // namespace

Daemon Daemon::detach() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw_errno("cannot create a pipe");
  }
  FileDescriptor reader(ends[0]);
  FileDescriptor writer(ends[1]);
  const pid_t child = fork();
  if (child < 0) {
    throw_errno("cannot fork");
  }
  if (child > 0) {
    writer = FileDescriptor();
    char ok = 0;
    ssize_t got = 0;
    do {
      got = read(reader.get(), &ok, 1);
    } while (got < 0 && errno == EINTR);
    _exit(got == 1 ? 0 : 1);
  }
  // Own process group, so that the terminal's Ctrl-C does not reach the daemon. No own session: the
  // kernel's autogroup scheduling would then weigh the daemon against all nodes of its cluster
  // together, which costs milliseconds on a loaded CPU.
  setpgid(0, 0);
  signal(SIGHUP, SIG_IGN);
  shed_inherited_attributes();
  return Daemon(std::move(writer));
}

void Daemon::ready() noexcept {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(null, STDERR_FILENO);  // until now errors went to the parent's terminal
  close(null);
  const ssize_t told = write(status_.get(), "1", 1);
  static_cast<void>(told);  // the parent may have ended
  status_ = FileDescriptor();
}

}  // namespace manycore
