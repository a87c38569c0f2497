// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

namespace manycore {

class Membership;
class TopicDsmWriter;

/// One thread's turn to write: holds the publisher's mutex and keeps the phase of its topic DSM
/// odd. In a child of fork() it ends without effect, as both are the parent's.
class Writing {
public:
  Writing(std::mutex & mutex, TopicDsmWriter & writer, const Membership & membership);
  Writing(Writing && other) noexcept = default;  ///< `other` has no turn afterwards
  Writing & operator=(Writing &&) = delete;
  ~Writing();

  /// False once moved from, and in a child of fork().
  bool is_on() const noexcept;

private:
  std::unique_lock<std::mutex> lock_;
  TopicDsmWriter & writer_;
  const Membership & membership_;
};

}  // namespace manycore
