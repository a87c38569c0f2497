// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "bench/node.hpp"

namespace manycore::bench {

/// Requesting side of two processes in conversation: each message is returned unchanged.
class Ping {
public:
  explicit Ping(size_t bytes);

  /// Returns after the first message has made the round trip.
  void connect();
  /// Returns the time from calling rmw_publish to returning from rmw_take, in ns.
  int64_t round_trip();
  /// Makes the other side end.
  void stop();

private:
  Node node_{"ping"};
  Publisher publisher_;
  Subscription subscription_;
  WaitSet wait_set_{node_};
  Message sent_;
  Message received_;
  uint64_t number_ = 0;
};

/// Answering side; calls `before(number)` before each answer, until Ping::stop().
void run_pong(const std::function<void(uint64_t number)> & before);

}  // namespace manycore::bench
