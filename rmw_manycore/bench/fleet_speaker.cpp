// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does publishing on a topic of a fleet cost while the whole fleet runs?
//
//   fleet_speaker topic=NAME warm_up=N iterations=N
//
// Publishes on a topic that nodes of `fleet` use, with pauses in which they take the message and
// sleep again. Prints how long each call of rcl_publish takes.
#include <rcl_interfaces/msg/parameter_event.h>
#include <rmw/qos_profiles.h>

#include <chrono>
#include <thread>

#include "bench/program.hpp"
#include "bench/rcl_node.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr auto poll_period = std::chrono::milliseconds(20);
constexpr auto pause = std::chrono::milliseconds(2);

void wait_for_subscription(const rcl_publisher_t & publisher) {
  for (size_t subscriptions = 0; subscriptions == 0;) {
    std::this_thread::sleep_for(poll_period);
    check_rcl(
      rcl_publisher_get_subscription_count(&publisher, &subscriptions),
      "rcl_publisher_get_subscription_count");
  }
}

void run(const Arguments & arguments) {
  RclContext context;
  RclNode node(context.get(), "speaker");
  const rcl_publisher_t & publisher = node.publish(
    arguments.text("topic"), ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, ParameterEvent),
    rmw_qos_profile_default);
  wait_for_subscription(publisher);
  rcl_interfaces__msg__ParameterEvent message;
  rcl_interfaces__msg__ParameterEvent__init(&message);
  const size_t warm_up = arguments.number("warm_up");
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < warm_up + arguments.number("iterations"); ++i) {
    std::this_thread::sleep_for(pause);
    const int64_t start_ns = monotonic_ns();
    check_rcl(rcl_publish(&publisher, &message, nullptr), "rcl_publish");
    samples_ns.push_back(monotonic_ns() - start_ns);
  }
  rcl_interfaces__msg__ParameterEvent__fini(&message);
  drop_warm_up(samples_ns, warm_up);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
