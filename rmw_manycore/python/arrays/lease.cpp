// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/lease.hpp"

#include <Python.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <map>
#include <thread>

#include "platform/private_pages.hpp"

namespace rmw_manycore {
namespace {

Lease * first = nullptr;
/// Of the threads that fork at this moment: the child closes it when it has its copies.
std::map<std::thread::id, std::array<int, 2>> pipes;

}  // namespace

Lease::Lease(
  const BorrowingInterface & interface, RecordHold * hold, const uint8_t * data,
  size_t size_bytes) noexcept
: interface_(interface),
  hold_(hold),
  data_(data),
  size_bytes_(size_bytes),
  next_(first),
  link_to_this_(&first) {
  if (next_ != nullptr) {
    next_->link_to_this_ = &next_;
  }
  first = this;
}

Lease::~Lease() {
  *link_to_this_ = next_;
  if (next_ != nullptr) {
    next_->link_to_this_ = link_to_this_;
  }
  if (hold_ != nullptr) {
    interface_.give_back(hold_);
  }
}

void Lease::give_back() noexcept {
  if (--holders_ == 0) {
    delete this;
  }
}

void Lease::before_fork() noexcept {
  if (first != nullptr && pipe2(pipes[std::this_thread::get_id()].data(), O_CLOEXEC) != 0) {
    Py_FatalError("rmw_manycore: no pipe for a child that inherits received messages");
  }
}

void Lease::after_fork_in_parent() noexcept {
  const auto own = pipes.extract(std::this_thread::get_id());
  if (own.empty()) {
    return;
  }
  const auto [read_end, write_end] = own.mapped();
  close(write_end);
  char byte = 0;
  while (read(read_end, &byte, 1) == -1 && errno == EINTR) {
  }
  close(read_end);
}

void Lease::after_fork_in_child() noexcept {
  for (Lease * lease = first; lease != nullptr; lease = lease->next_) {
    if (lease->hold_ == nullptr) {
      continue;
    }
    if (!manycore::make_pages_private(lease->data_, lease->size_bytes_)) {
      Py_FatalError("rmw_manycore: no memory for received messages that a child inherits");
    }
    if (!lease->interface_.is_kept(lease->hold_)) {
      Py_FatalError(
        "rmw_manycore: the parent was killed before its child had copied received messages");
    }
    lease->hold_ = nullptr;  // the parent's
  }
  for (const auto & [thread, ends] : pipes) {  // also those of threads that the child lacks
    close(ends[0]);
    close(ends[1]);
  }
  pipes.clear();
}

}  // namespace rmw_manycore
