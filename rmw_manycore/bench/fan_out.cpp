// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How old is a message when each of many subscribers takes it, at a constant rate?
//
//   fan_out role=sink depth=N best_effort=0|1
//   fan_out role=source depth=N best_effort=0|1 bytes=N subscribers=N rate_hz=N warm_up=N
//           iterations=N
//
// The source prints "ready" when it is matched with all sinks, and starts when its input ends. A
// sink prints the age of each message in order of arrival, and ends when its input ends. There are
// `iterations` samples unless messages were lost.
#include <optional>
#include <thread>

#include "bench/node.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr uint64_t warm_up_stamp = 0;

rmw_qos_profile_t qos(const Arguments & arguments) {
  rmw_qos_profile_t qos = reliable_qos(arguments.number("depth"));
  if (arguments.number("best_effort") != 0) {
    qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  }
  return qos;
}

void source(const Arguments & arguments) {
  Node node("source");
  Publisher publisher(node, "/data", qos(arguments));
  wait_until_matched(publisher, arguments.number("subscribers"));
  announce_ready();
  wait_for_end_of_input();
  Message message;
  message.data.resize(arguments.number("bytes"));
  const std::chrono::nanoseconds period(manycore::ns_per_s / arguments.number("rate_hz"));
  auto next = std::chrono::steady_clock::now();
  const size_t warm_up = arguments.number("warm_up");
  const size_t messages = warm_up + arguments.number("iterations");
  for (size_t i = 0; i < messages; ++i) {
    std::this_thread::sleep_until(next += period);
    set_number(message, i < warm_up ? warm_up_stamp : static_cast<uint64_t>(monotonic_ns()));
    publisher.publish(message);
  }
  std::this_thread::sleep_until(next += period);
  stop_subscribers(publisher);
}

void sink(const Arguments & arguments) {
  Node node("sink");
  std::optional<Subscription> subscription(std::in_place, node, "/data", qos(arguments));
  WaitSet wait_set(node);
  Message message;
  std::vector<int64_t> samples_ns;
  while (true) {
    take_next(wait_set, *subscription, message);
    if (message.data.empty()) {
      subscription.reset();  // the source waits for this
      print_samples(samples_ns);
      return wait_for_end_of_input();
    }
    if (number_of(message) != warm_up_stamp) {
      samples_ns.push_back(monotonic_ns() - static_cast<int64_t>(number_of(message)));
    }
  }
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    arguments.text("role") == "source" ? source(arguments) : sink(arguments);
  });
}
