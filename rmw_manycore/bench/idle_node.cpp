// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does an idle node cost? The orchestrator measures it from outside.
//
//   idle_node name=NAME
//
// Publishes and subscribes to its own topic and waits without a timeout until its input ends.
#include <thread>

#include "bench/node.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

void idle(const Arguments & arguments) {
  const std::string & name = arguments.text("name");
  Node node(name);
  Publisher publisher(node, "/" + name, reliable_qos(1));
  Subscription subscription(node, "/" + name, reliable_qos(1));
  WaitSet wait_set(node);
  rmw_guard_condition_t * end = rmw_create_guard_condition(node.context());
  std::thread waiter([&] { wait_set.wait(subscription, std::nullopt, end); });
  announce_ready();
  wait_for_end_of_input();
  check(rmw_trigger_guard_condition(end), "rmw_trigger_guard_condition");
  waiter.join();
  check(rmw_destroy_guard_condition(end), "rmw_destroy_guard_condition");
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, idle); }
