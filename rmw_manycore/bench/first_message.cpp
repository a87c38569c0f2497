// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long after rmw_init does the first message arrive?
//
//   first_message role=publisher         keeps one message for late subscribers, until its input
//   ends first_message role=joining           subscribes to an existing publisher first_message
//   role=alone             publishes to itself, as the first process of the platform
#include "bench/node.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr char topic[] = "/latched";
constexpr size_t bytes = 64;

Message example() {
  Message message;
  message.data.resize(bytes);
  return message;
}

void publisher() {
  Node node("publisher");
  Publisher publisher(node, topic, latched_qos());
  publisher.publish(example());
  announce_ready();
  wait_for_end_of_input();
}

void measure(bool alone) {
  const int64_t start_ns = monotonic_ns();
  Node node("subscriber");
  Subscription subscription(node, topic, latched_qos());
  std::optional<Publisher> publisher;
  if (alone) {
    publisher.emplace(node, topic, latched_qos());
    publisher->publish(example());
  }
  WaitSet wait_set(node);
  Message message;
  take_next(wait_set, subscription, message);
  print_samples({monotonic_ns() - start_ns});
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    const std::string & role = arguments.text("role");
    role == "publisher" ? publisher() : measure(role == "alone");
  });
}
