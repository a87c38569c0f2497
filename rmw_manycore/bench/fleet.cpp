// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Nodes as they are run by the hundred, at the rcl level: each has the parameter services, uses
// /rosout and /parameter_events, and publishes two topics to which the next node subscribes.
//
//   fleet first=N nodes=N all=N period_ms=N
//
// Runs nodes `first` to `first + nodes - 1` of `all` in one process, with one thread that waits for
// all of them. Prints "ready" when each topic is matched, or at once if `all` is 0. From then on it
// publishes on each topic every `period_ms`; never if that is 0. Ends when its input ends. The
// samples are the times to create each node.
#include <rcl_interfaces/msg/parameter_event.h>
#include <rmw/qos_profiles.h>

#include <atomic>
#include <deque>
#include <thread>
#include <utility>

#include "bench/program.hpp"
#include "bench/rcl_node.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr auto poll_period = std::chrono::milliseconds(20);
constexpr size_t topics_of_a_node = 2;

const rosidl_message_type_support_t * event_type() {
  return ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, ParameterEvent);
}

std::string topic(size_t node, size_t number) {
  return "/fleet_" + std::to_string(node) + "_" + std::to_string(number);
}

class FleetNode {
public:
  FleetNode(rcl_context_t & context, size_t number, size_t all)
  : node_(context, "fleet_" + std::to_string(number)) {
    for (size_t i = 0; i < topics_of_a_node; ++i) {
      own_topics_.push_back(
        &node_.publish(topic(number, i), event_type(), rmw_qos_profile_default));
      if (all != 0) {
        node_.subscribe(topic((number + 1) % all, i), event_type(), rmw_qos_profile_default);
      }
    }
  }

  bool is_matched() const {
    for (const rcl_publisher_t * publisher : own_topics_) {
      size_t subscribers = 0;
      check_rcl(
        rcl_publisher_get_subscription_count(publisher, &subscribers),
        "rcl_publisher_get_subscription_count");
      if (subscribers == 0) {
        return false;
      }
    }
    return true;
  }

  const RclNode & node() const { return node_; }

  /// Publishes on each of the node's topics. Not concurrently with the constructor.
  void publish_all() const {
    rcl_interfaces__msg__ParameterEvent message;
    rcl_interfaces__msg__ParameterEvent__init(&message);
    for (const rcl_publisher_t * publisher : own_topics_) {
      check_rcl(rcl_publish(publisher, &message, nullptr), "rcl_publish");
    }
    rcl_interfaces__msg__ParameterEvent__fini(&message);
  }

private:
  RclNode node_;
  std::vector<const rcl_publisher_t *> own_topics_;
};

using Fleet = std::deque<FleetNode>;

/// Acts as a single executor of all nodes until `end` is triggered. While the fleet is silent, a
/// wake-up for anything but a subscription, whose publisher is outside, is an error. There need not
/// be a message: a subscription looks again when a publisher leaves that may have had one.
void wait_for_anything(
  RclContext & context, const Fleet & fleet, const RclGuardCondition & end, bool is_silent) {
  std::vector<const RclNode *> nodes;
  for (const FleetNode & node : fleet) {
    nodes.push_back(&node.node());
  }
  RclWaitSet wait_set(context.get(), std::move(nodes), end);
  do {
    wait_set.wait();
    bool is_for_messages = false;
    wait_set.for_each_ready_subscription([&](const rcl_subscription_t & subscription) {
      is_for_messages = true;
      take_parameter_event(subscription);
    });
    if (is_silent && !is_for_messages && !wait_set.is_ended()) {
      throw std::runtime_error("a node of the fleet woke up, but not for a subscription");
    }
  } while (!wait_set.is_ended());
}

/// Publishes on all topics in each period during its lifetime.
class Speaker {
public:
  Speaker(const Fleet & fleet, std::chrono::milliseconds period)
  : thread_([this, &fleet, period] {
      while (running_ && period.count() > 0) {
        for (const FleetNode & node : fleet) {
          node.publish_all();
        }
        std::this_thread::sleep_for(period);
      }
    }) {}
  Speaker(const Speaker &) = delete;
  Speaker & operator=(const Speaker &) = delete;
  ~Speaker() {
    running_ = false;
    thread_.join();
  }

private:
  std::atomic<bool> running_{true};
  std::thread thread_;
};

void run(const Arguments & arguments) {
  RclContext context;
  Fleet fleet;
  std::vector<int64_t> samples_ns;
  const size_t first = arguments.number("first");
  for (size_t i = first; i < first + arguments.number("nodes"); ++i) {
    const int64_t start_ns = monotonic_ns();
    fleet.emplace_back(context.get(), i, arguments.number("all"));
    samples_ns.push_back(monotonic_ns() - start_ns);
  }
  RclGuardCondition end(context);
  const std::chrono::milliseconds period(arguments.number("period_ms"));
  std::thread waiter([&] { wait_for_anything(context, fleet, end, period.count() == 0); });
  for (const FleetNode & node : fleet) {
    while (arguments.number("all") != 0 && !node.is_matched()) {
      std::this_thread::sleep_for(poll_period);
    }
  }
  {
    const Speaker speaker(fleet, period);
    announce_ready();
    wait_for_end_of_input();
  }
  end.trigger();
  waiter.join();
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
