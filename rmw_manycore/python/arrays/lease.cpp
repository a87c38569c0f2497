// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/arrays/lease.hpp"

#include <Python.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "platform/private_pages.hpp"

namespace rmw_manycore {
namespace {

Lease * first = nullptr;
/// Closed by the child when it has its copies; -1: there is nothing to wait for.
int copied[2] = {-1, -1};

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
  if (first != nullptr && pipe2(copied, O_CLOEXEC) != 0) {
    Py_FatalError("rmw_manycore: no pipe for a child that inherits received messages");
  }
}

void Lease::after_fork_in_parent() noexcept {
  if (copied[0] == -1) {
    return;
  }
  close(copied[1]);
  char byte = 0;
  while (read(copied[0], &byte, 1) == -1 && errno == EINTR) {
  }
  close(copied[0]);
  copied[0] = copied[1] = -1;
}

void Lease::after_fork_in_child() noexcept {
  for (Lease * lease = first; lease != nullptr; lease = lease->next_) {
    if (
      lease->hold_ != nullptr && !manycore::make_pages_private(lease->data_, lease->size_bytes_)) {
      Py_FatalError("rmw_manycore: no memory for received messages that a child inherits");
    }
    lease->hold_ = nullptr;  // the parent's
  }
  if (copied[0] != -1) {
    close(copied[0]);
    close(copied[1]);
    copied[0] = copied[1] = -1;
  }
}

}  // namespace rmw_manycore
