// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace rmw_manycore {

/// Messages of one plain type that an endpoint lends to its user. What is given back is lent again,
/// so a steady user allocates nothing. A loan belongs to its endpoint, and goes with it at the
/// latest. Thread-safe.
class Loans {
public:
  /// `message_bytes`: size of the type in memory; 0 = of a type that is not lent.
  explicit Loans(size_t message_bytes) : message_bytes_(message_bytes) {}

  bool lends() const noexcept { return message_bytes_ != 0; }
  /// A message of zeros, aligned for any plain type.
  void * lend();
  bool is_lent(const void * message) const;
  /// False when it is not lent.
  bool give_back(const void * message);

private:
  using Message = std::unique_ptr<std::byte[]>;
  using Messages = std::vector<Message>;
  Messages::const_iterator find(const void * message) const;

  const size_t message_bytes_;
  mutable std::mutex mutex_;
  Messages lent_;
  Messages free_;
};

}  // namespace rmw_manycore
