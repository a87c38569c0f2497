// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/process_threads.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

namespace manycore {
namespace {

/// Text of a small file of proc(5): empty if this process may not read it, nothing if its thread
/// has ended.
std::optional<std::string> read_all(const FileDescriptor & file) {
  std::array<char, 256> text;
  const ssize_t size = pread(file.get(), text.data(), text.size(), 0);
  if (size < 0 && errno == ESRCH) {
    return std::nullopt;
  }
  return std::string(text.data(), size > 0 ? static_cast<size_t>(size) : 0);
}

bool contains(const std::vector<pid_t> & all, pid_t one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

struct Call {
  long number = -1;
  std::array<unsigned long, 6> arguments{};
};

Call parse(const std::string & text) {
  Call call;
  std::sscanf(
    text.c_str(), "%ld %lx %lx %lx %lx %lx %lx", &call.number, &call.arguments[0],
    &call.arguments[1], &call.arguments[2], &call.arguments[3], &call.arguments[4],
    &call.arguments[5]);
  return call;
}

/// Whether only another thread of its process or the outside ends the call. Timeouts of futexes are
/// allowed where not `strict`: libraries have threads that look at something every few seconds.
/// Those of futex_wait(), in shared memory, are not: another process computes for the thread, as
/// workers do. glibc and other libraries wait there with other flags.
bool is_sleep(const Call & call, bool strict) {
  switch (call.number) {
    case SYS_futex: {
      const auto command = call.arguments[1] & static_cast<unsigned long>(FUTEX_CMD_MASK);
      const bool is_private = (call.arguments[1] & FUTEX_PRIVATE_FLAG) != 0;
      const bool waits = command == FUTEX_WAIT || command == FUTEX_WAIT_BITSET;
      const bool is_ours = call.arguments[1] == FUTEX_WAIT_BITSET;
      return waits && !is_ours && (!strict || (is_private && call.arguments[3] == 0));
    }
#ifdef SYS_poll
    case SYS_poll:
    case SYS_select:
    case SYS_epoll_wait:
#endif
    case SYS_ppoll:
    case SYS_pselect6:
    case SYS_epoll_pwait:
    case SYS_read:
    case SYS_recvmsg:
    case SYS_recvfrom:
    case SYS_accept:
    case SYS_accept4:
    case SYS_rt_sigtimedwait:
    case SYS_rt_sigsuspend:
      return !strict;
    default:
      return false;
  }
}

/// Whether an open file is a regular one: a read of it waits for a disk, not for another process.
bool is_file(const std::string & link) {
  struct stat status {};
  return stat(link.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

std::string name_of(const Call & call) {
  switch (call.number) {
    case SYS_read:
      return "reads a file";
    case SYS_futex:
      return "waits for a lock, for another process, or with a timeout of the wall clock";
    case SYS_clock_nanosleep:
    case SYS_nanosleep:
      return "sleeps by the wall clock";
    case SYS_write:
    case SYS_sendto:
    case SYS_sendmsg:
      return "writes to a full pipe or socket";
    default:
      return "is in system call " + std::to_string(call.number);
  }
}

}  // namespace

ProcessThreads::ProcessThreads(pid_t pid) : directory_("/proc/" + std::to_string(pid) + "/task") {}

void ProcessThreads::list_again() {
  const std::unique_ptr<DIR, int (*)(DIR *)> tasks(opendir(directory_.c_str()), closedir);
  std::map<pid_t, Files> now;
  while (const dirent * const entry = tasks ? readdir(tasks.get()) : nullptr) {
    const pid_t tid = std::atoi(entry->d_name);
    const std::string files = directory_ + "/" + entry->d_name;
    const auto known = threads_.find(tid);
    if (known != threads_.end() && read_all(known->second.call)) {
      now[tid] = std::move(known->second);
    } else if (tid > 0) {
      const auto file = [&](const char * name) {
        return FileDescriptor(open((files + name).c_str(), O_RDONLY | O_CLOEXEC));
      };
      Files opened{file("/syscall"), file("/schedstat")};
      if (opened.call) {
        now[tid] = std::move(opened);
      } else if (errno == ENOENT || errno == ESRCH) {
        count_ = 0;  // it has ended; another thread may have begun since
      }
    }
  }
  threads_ = std::move(now);
}

ProcessThreads::Look ProcessThreads::look_once(
  const std::vector<pid_t> & blocked, const std::vector<pid_t> & strict, std::string & seen) {
  for (const auto & [tid, files] : threads_) {
    if (contains(blocked, tid)) {
      continue;
    }
    const std::optional<std::string> text = read_all(files.call);
    if (!text) {
      count_ = 0;  // another thread may have begun since: the list is made again
      return {false, 0, ""};
    }
    if (text->empty()) {
      continue;  // Yama hides it: taken to sleep
    }
    const Call call = parse(*text);
    const bool reads_file =
      call.number == SYS_read &&
      is_file(directory_ + "/" + std::to_string(tid) + "/fd/" + std::to_string(call.arguments[0]));
    if (reads_file || !is_sleep(call, contains(strict, tid))) {
      return {false, tid, call.number < 0 ? "" : name_of(call)};
    }
    seen += *text + read_all(files.turns).value_or("");
  }
  return {};
}

ProcessThreads::Look ProcessThreads::look(
  const std::vector<pid_t> & blocked, const std::vector<pid_t> & strict) {
  struct stat status {};
  if (stat(directory_.c_str(), &status) != 0) {
    return {};  // the process has ended
  }
  if (std::exchange(count_, status.st_nlink) != status.st_nlink) {
    list_again();
  }
  std::string first;
  std::string second;
  Look found = look_once(blocked, strict, first);
  if (!found.asleep) {
    return found;
  }
  found = look_once(blocked, strict, second);
  struct stat after {};
  if (
    found.asleep &&
    (first != second || stat(directory_.c_str(), &after) != 0 || after.st_nlink != count_)) {
    found.asleep = false;
  }
  return found;
}

}  // namespace manycore
