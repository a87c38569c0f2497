// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "bench/node.hpp"

namespace manycore::bench {

/// The asking half of a conversation of two processes: every message comes back unchanged.
class Ping {
public:
  explicit Ping(size_t bytes);

  /// Returns once a first message has made it there and back.
  void connect();
  /// Returns the time from the call of rmw_publish to the return of rmw_take, in ns.
  int64_t round_trip();
  /// Lets the other half end.
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

/// The answering half; `before(number)` is called before each answer, until ping says stop.
void run_pong(const std::function<void(uint64_t number)> & before);

}  // namespace manycore::bench
