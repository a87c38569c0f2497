// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace manycore {

/// Room for a message in a chunk of its own, until it is published or destroyed. Any thread may
/// have it, and a publisher several at a time. It must not outlive its publisher. In a child of
/// fork() the destructor has no effect.
class Loan {
public:
  Loan(Loan && other) noexcept;
  Loan & operator=(Loan &&) = delete;
  ~Loan();

  uint8_t * data() const noexcept { return data_; }
  size_t capacity() const noexcept { return capacity_bytes_; }

private:
  friend class Publisher;
  struct Lent;  ///< which chunk, and whose
  explicit Loan(std::unique_ptr<Lent> lent) noexcept;

  std::unique_ptr<Lent> lent_;  ///< nullptr after a move, and once published
  uint8_t * data_;
  size_t capacity_bytes_;
};

}  // namespace manycore
