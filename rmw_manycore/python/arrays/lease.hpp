// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "rmw/borrowing/interface.hpp"

namespace rmw_manycore {

/// The hold of a record, shared by the arrays that lie in it. Used with Python's lock only.
class Lease {
public:
  /// Takes over the hold, and counts one holder. `data` is the range that the arrays lie in.
  Lease(
    const BorrowingInterface & interface, RecordHold * hold, const uint8_t * data,
    size_t size_bytes) noexcept;
  Lease(const Lease &) = delete;
  Lease & operator=(const Lease &) = delete;

  void keep() noexcept { ++holders_; }
  /// The last one gives the record back.
  void give_back() noexcept;

  // Around a fork: the child gets private copies of what it holds, at the same addresses. Its
  // parent gives nothing back and writes nothing before they are made.
  static void before_fork() noexcept;
  static void after_fork_in_parent() noexcept;
  static void after_fork_in_child() noexcept;

private:
  ~Lease();

  const BorrowingInterface & interface_;
  RecordHold * hold_;  ///< null in a child of fork()
  const uint8_t * data_;
  size_t size_bytes_;
  size_t holders_ = 1;
  Lease * next_;
  Lease ** link_to_this_;
};

}  // namespace rmw_manycore
