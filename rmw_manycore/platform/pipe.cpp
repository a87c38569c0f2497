// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/pipe.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "platform/error.hpp"

namespace manycore {
namespace {

/// The most an ordinary user may ask for; 16,384 messages of 64 bytes.
constexpr int pipe_capacity_bytes = 1 << 20;

LastingDescriptor open_end(const std::string & path, int more_flags) {
  const int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | more_flags;
  FileDescriptor fd(::open(path.c_str(), flags));
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
  fcntl(sender.get(), F_SETPIPE_SZ, pipe_capacity_bytes);  // best effort: user quota may forbid it
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
  char unread[4096];  // a page: less may make no room
  while (!try_send(message, size_bytes) && sender_.get() >= 0) {
    const ssize_t taken = ::read(sender_.get(), unread, sizeof unread);
    static_cast<void>(taken);  // none when the receiver was faster
  }
}

size_t Pipe::receive(void * buffer, size_t capacity_bytes) const {
  const ssize_t got = ::read(receiver_.get(), buffer, capacity_bytes);
  if (got < 0 && errno != EINTR) {
    throw_errno("cannot read the cluster's pipe");
  }
  return got < 0 ? 0 : static_cast<size_t>(got);
}

}  // namespace manycore
