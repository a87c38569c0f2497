// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/private_directory.hpp"

namespace manycore {
namespace {

/// Default limit for unprivileged users; 16,384 messages of 64 bytes.
constexpr int pipe_capacity_bytes = 1 << 20;

LastingDescriptor open_end(const std::string & path, int more_flags) {
  const int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | more_flags;
  FileDescriptor fd = open_private_file(path, flags);
  if (!fd) {
    throw_errno("cannot open " + path);
  }
  struct stat status {};
  if (fstat(fd.get(), &status) != 0 || !S_ISFIFO(status.st_mode)) {
    throw Error(ErrorCode::corrupt, path + " is not a pipe; remove it with 'manycore clean'");
  }
  return LastingDescriptor(std::move(fd), path, flags);
}

}  // namespace

void Pipe::create(const std::string & path) {
  if (mkfifo(path.c_str(), 0600) != 0 && errno != EEXIST) {
    throw_errno("cannot create pipe " + path);
  }
}

Pipe Pipe::open(const std::string & path) {
  LastingDescriptor sender = open_end(path, O_NONBLOCK);
  LastingDescriptor receiver = open_end(path, 0);
  // Best effort: a user's pipe quota may forbid it.
  fcntl(sender.get(), F_SETPIPE_SZ, pipe_capacity_bytes);
  return Pipe(std::move(sender), std::move(receiver));
}

bool Pipe::try_send(const void * message, size_t size_bytes) const noexcept {
  ssize_t written = 0;
  do {
    written = ::write(sender_.get(), message, size_bytes);
  } while (written < 0 && errno == EINTR);
  return written == static_cast<ssize_t>(size_bytes);
}

void Pipe::send_last(const void * message, size_t size_bytes) const noexcept {
  char unread[4096];  // one page: smaller reads may free no room
  while (!try_send(message, size_bytes) && sender_.get() >= 0) {
    const ssize_t taken = ::read(sender_.get(), unread, sizeof unread);
    static_cast<void>(taken);  // the receiver may have emptied the pipe
  }
}

size_t Pipe::receive(void * buffer, size_t capacity_bytes) const {
  const ssize_t got = ::read(receiver_.get(), buffer, capacity_bytes);
  if (got < 0 && errno != EINTR) {
    throw_errno("cannot read the cluster's pipe");
  }
  return got < 0 ? 0 : static_cast<size_t>(got);
}

bool Pipe::wait_for_room(int64_t until_ns) const noexcept {
  pollfd end{sender_.get(), POLLOUT, 0};
  const int64_t left_ns = until_ns - monotonic_ns();
  if (left_ns <= 0 || end.fd < 0) {
    return false;
  }
  const timespec timeout = to_timespec(left_ns);
  return ppoll(&end, 1, &timeout, nullptr) == 1 || errno == EINTR;
}

size_t Pipe::waiting_bytes() const noexcept {
  int bytes = 0;
  return ioctl(receiver_.get(), FIONREAD, &bytes) == 0 ? static_cast<size_t>(bytes) : 0;
}

size_t Pipe::wait_for_first(const std::vector<Pipe> & pipes) {
  std::vector<pollfd> ends;
  for (const Pipe & pipe : pipes) {
    ends.push_back({pipe.receiver_.get(), POLLIN, 0});
  }
  while (true) {
    if (poll(ends.data(), ends.size(), -1) < 0 && errno != EINTR) {
      throw_errno("cannot wait for a pipe");
    }
    const auto readable = std::find_if(
      ends.begin(), ends.end(), [](const pollfd & end) { return (end.revents & POLLIN) != 0; });
    if (readable != ends.end()) {
      return static_cast<size_t>(readable - ends.begin());
    }
  }
}

}  // namespace manycore
