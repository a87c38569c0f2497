// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Endpoints of one topic that are created, closed and killed over and over. What others feel of it
// is measured by `matches` and `round_trip` meanwhile.
//
//   churn endpoints=N changes=N cpu=N
//
// A child creates `endpoints` publishers and as many subscriptions. Then it creates and closes
// `changes` times one more of each, whose message is not taken, and is killed. The next child
// follows, until this program is killed. It is ready when the first child has all its endpoints.
#include <memory>
#include <vector>

#include "bench/node.hpp"
#include "bench/peer.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

constexpr const char * topic = "/changing";

void change_and_die(const Arguments & arguments, Slot & announced) {
  Node node("churn");
  const rmw_qos_profile_t qos = reliable_qos(1);
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (size_t i = 0; i < arguments.number("endpoints"); ++i) {
    publishers.push_back(std::make_unique<Publisher>(node, topic, qos));
    subscriptions.push_back(std::make_unique<Subscription>(node, topic, qos));
  }
  announced.announce(1);
  Message message;
  message.data.resize(64);
  for (size_t i = 0; i < arguments.number("changes"); ++i) {
    const Subscription subscription(node, topic, qos);
    Publisher(node, topic, qos).publish(message);
  }
  kill(getpid(), SIGKILL);
}

[[noreturn]] void churn(const Arguments & arguments) {
  Slot & announced = Slot::create(0);
  bool is_first = true;
  while (true) {
    fork_on(arguments.number("cpu"), [&] { change_and_die(arguments, announced); });
    if (is_first) {
      announced.wait_for(1);
      announce_ready();
    }
    is_first = false;
    wait_for_children();
  }
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, churn); }
