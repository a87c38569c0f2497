// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace rmw_manycore {

/// Messages of one plain type that an endpoint loans to its user. Returned messages are reused, so
/// the steady state allocates nothing. A loan belongs to its endpoint and ends with it.
/// Thread-safe.
class Loans {
public:
  /// `message_bytes` is the size of the type in memory; 0 = the type cannot be loaned.
  explicit Loans(size_t message_bytes) : message_bytes_(message_bytes) {}

  bool lends() const noexcept { return message_bytes_ != 0; }
  /// Returns a message, aligned for any plain type. As in rmw_fastrtps_cpp, it is not initialized:
  /// a take overwrites all of it, and so does a publisher.
  void * lend();
  bool is_lent(const void * message) const;
  /// False if the message is not on loan.
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
