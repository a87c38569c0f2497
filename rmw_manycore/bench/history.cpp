// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does publishing cost a transient-local publisher that keeps a deep history?
//
//   history depth=N iterations=N
//
// Fills the history, then prints how long each further publish takes. Each displaces the oldest
// message. One subscription has matched before the first message. It takes every message, outside
// of the measured time.
#include "bench/node.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr size_t message_bytes = 64;

rmw_qos_profile_t keeping(size_t depth) {
  rmw_qos_profile_t qos = latched_qos();
  qos.depth = depth;
  return qos;
}

void run(const Arguments & arguments) {
  Node node("history");
  const size_t depth = arguments.number("depth");
  Publisher publisher(node, "/kept", keeping(depth));
  Subscription subscription(node, "/kept", latched_qos());
  wait_until_matched(publisher, subscription);
  WaitSet wait_set(node);
  Message message;
  message.data.resize(message_bytes);
  Message taken;
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < depth + arguments.number("iterations"); ++i) {
    const int64_t start_ns = monotonic_ns();
    publisher.publish(message);
    samples_ns.push_back(monotonic_ns() - start_ns);
    take_next(wait_set, subscription, taken);
  }
  drop_warm_up(samples_ns, depth);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
