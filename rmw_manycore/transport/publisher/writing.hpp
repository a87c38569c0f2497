// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

namespace manycore {

class Membership;
class TopicDsmWriter;

/// Exclusive access of one thread to the topic DSM: holds the publisher's mutex and keeps the phase
/// odd. In a child of fork() the destructor has no effect, because mutex and phase belong to the
/// parent.
class Writing {
public:
  Writing(std::mutex & mutex, TopicDsmWriter & writer, const Membership & membership);
  Writing(Writing && other) noexcept = default;  ///< `other` has no access afterwards
  Writing & operator=(Writing &&) = delete;
  ~Writing();

  /// False after a move, and in a child of fork().
  bool is_on() const noexcept;

private:
  std::unique_lock<std::mutex> lock_;
  TopicDsmWriter & writer_;
  const Membership & membership_;
};

}  // namespace manycore
