// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Nodes as people run them by the hundred, at the level of rcl: each has the services of its
// parameters, is on /rosout and /parameter_events, and two topics that the next node subscribes to.
//
//   fleet first=N nodes=N all=N
//
// Nodes `first` to `first + nodes - 1` of `all`, in one process with one thread that waits for them
// all. It is ready when each topic has found its subscription, or, where `all` is 0, at once; it
// ends with its input. The samples are the times that each node took to create.
#include <rcl/error_handling.h>
#include <rcl/logging_rosout.h>
#include <rcl/rcl.h>
#include <rcl_interfaces/msg/log.h>
#include <rcl_interfaces/msg/parameter_event.h>
#include <rcl_interfaces/srv/describe_parameters.h>
#include <rcl_interfaces/srv/get_parameter_types.h>
#include <rcl_interfaces/srv/get_parameters.h>
#include <rcl_interfaces/srv/list_parameters.h>
#include <rcl_interfaces/srv/set_parameters.h>
#include <rcl_interfaces/srv/set_parameters_atomically.h>
#include <rmw/qos_profiles.h>
#include <type_description_interfaces/srv/get_type_description.h>

#include <array>
#include <deque>
#include <thread>

#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr auto look_again_after = std::chrono::milliseconds(20);
constexpr size_t topics_of_a_node = 2;

void check(rcl_ret_t status, const char * what) {
  if (status != RCL_RET_OK) {
    const std::string reason = rcl_get_error_string().str;
    rcl_reset_error();
    throw std::runtime_error(std::string(what) + " failed: " + reason);
  }
}

struct ServiceKind {
  const char * name;
  const rosidl_service_type_support_t * type;
};

std::array<ServiceKind, 7> services_of_a_node() {
#define KIND(name, package, type) {name, ROSIDL_GET_SRV_TYPE_SUPPORT(package, srv, type)}
  return {{
    KIND("~/describe_parameters", rcl_interfaces, DescribeParameters),
    KIND("~/get_parameter_types", rcl_interfaces, GetParameterTypes),
    KIND("~/get_parameters", rcl_interfaces, GetParameters),
    KIND("~/list_parameters", rcl_interfaces, ListParameters),
    KIND("~/set_parameters", rcl_interfaces, SetParameters),
    KIND("~/set_parameters_atomically", rcl_interfaces, SetParametersAtomically),
    KIND("~/get_type_description", type_description_interfaces, GetTypeDescription),
  }};
#undef KIND
}

const rosidl_message_type_support_t * event_type() {
  return ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, ParameterEvent);
}

const rosidl_message_type_support_t * log_type() {
  return ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, Log);
}

std::string topic(size_t node, size_t number) {
  return "/fleet_" + std::to_string(node) + "_" + std::to_string(number);
}

class FleetNode {
public:
  FleetNode(rcl_context_t & context, size_t number, size_t all) {
    const rcl_node_options_t options = rcl_node_get_default_options();
    const std::string name = "fleet_" + std::to_string(number);
    check(rcl_node_init(&node_, name.c_str(), "", &context, &options), "rcl_node_init");
    publish("/rosout", log_type(), rcl_qos_profile_rosout_default);
    publish("/parameter_events", event_type(), rmw_qos_profile_parameter_events);
    subscribe("/parameter_events", rmw_qos_profile_parameter_events);
    for (const ServiceKind & kind : services_of_a_node()) {
      serve(kind);
    }
    for (size_t i = 0; i < topics_of_a_node; ++i) {
      own_topics_.push_back(&publish(topic(number, i), event_type(), rmw_qos_profile_default));
      if (all != 0) {
        subscribe(topic((number + 1) % all, i), rmw_qos_profile_default);
      }
    }
  }
  FleetNode(const FleetNode &) = delete;
  FleetNode & operator=(const FleetNode &) = delete;
  ~FleetNode() {
    for (rcl_service_t & service : services) {
      finish(rcl_service_fini(&service, &node_));
    }
    for (rcl_subscription_t & subscription : subscriptions) {
      finish(rcl_subscription_fini(&subscription, &node_));
    }
    for (rcl_publisher_t & publisher : publishers_) {
      finish(rcl_publisher_fini(&publisher, &node_));
    }
    finish(rcl_node_fini(&node_));
  }

  bool is_matched() const {
    for (const rcl_publisher_t * publisher : own_topics_) {
      size_t subscribers = 0;
      check(
        rcl_publisher_get_subscription_count(publisher, &subscribers),
        "rcl_publisher_get_subscription_count");
      if (subscribers == 0) {
        return false;
      }
    }
    return true;
  }

  std::deque<rcl_subscription_t> subscriptions;
  std::deque<rcl_service_t> services;

private:
  rcl_publisher_t & publish(
    const std::string & name, const rosidl_message_type_support_t * type,
    const rmw_qos_profile_t & qos) {
    rcl_publisher_options_t options = rcl_publisher_get_default_options();
    options.qos = qos;
    rcl_publisher_t publisher = rcl_get_zero_initialized_publisher();
    check(
      rcl_publisher_init(&publisher, &node_, type, name.c_str(), &options), "rcl_publisher_init");
    return publishers_.emplace_back(publisher);
  }

  void subscribe(const std::string & name, const rmw_qos_profile_t & qos) {
    rcl_subscription_options_t options = rcl_subscription_get_default_options();
    options.qos = qos;
    rcl_subscription_t subscription = rcl_get_zero_initialized_subscription();
    check(
      rcl_subscription_init(&subscription, &node_, event_type(), name.c_str(), &options),
      "rcl_subscription_init");
    subscriptions.push_back(subscription);
  }

  void serve(const ServiceKind & kind) {
    const rcl_service_options_t options = rcl_service_get_default_options();
    rcl_service_t service = rcl_get_zero_initialized_service();
    check(rcl_service_init(&service, &node_, kind.type, kind.name, &options), "rcl_service_init");
    services.push_back(service);
  }

  static void finish(rcl_ret_t status) {
    if (status != RCL_RET_OK) {
      std::fprintf(stderr, "fleet: %s\n", rcl_get_error_string().str);
      rcl_reset_error();
    }
  }

  rcl_node_t node_ = rcl_get_zero_initialized_node();
  std::deque<rcl_publisher_t> publishers_;
  std::vector<const rcl_publisher_t *> own_topics_;
};

class Context {
public:
  Context() {
    rcl_init_options_t options = rcl_get_zero_initialized_init_options();
    check(rcl_init_options_init(&options, rcl_get_default_allocator()), "rcl_init_options_init");
    check(rcl_init(0, nullptr, &options, &context_), "rcl_init");
    check(rcl_init_options_fini(&options), "rcl_init_options_fini");
  }
  Context(const Context &) = delete;
  Context & operator=(const Context &) = delete;
  ~Context() {
    if (rcl_shutdown(&context_) != RCL_RET_OK || rcl_context_fini(&context_) != RCL_RET_OK) {
      std::fprintf(stderr, "fleet: %s\n", rcl_get_error_string().str);
    }
  }
  rcl_context_t & get() { return context_; }

private:
  rcl_context_t context_ = rcl_get_zero_initialized_context();
};

using Fleet = std::deque<FleetNode>;

/// As one executor of all nodes, until `end` is triggered. Nothing arrives meanwhile.
void wait_for_anything(Context & context, Fleet & fleet, rcl_guard_condition_t & end) {
  size_t subscriptions = 0;
  size_t services = 0;
  for (const FleetNode & node : fleet) {
    subscriptions += node.subscriptions.size();
    services += node.services.size();
  }
  rcl_wait_set_t wait_set = rcl_get_zero_initialized_wait_set();
  check(
    rcl_wait_set_init(
      &wait_set, subscriptions, 1, 0, 0, services, 0, &context.get(), rcl_get_default_allocator()),
    "rcl_wait_set_init");
  for (const FleetNode & node : fleet) {
    for (const rcl_subscription_t & subscription : node.subscriptions) {
      check(rcl_wait_set_add_subscription(&wait_set, &subscription, nullptr), "rcl_wait_set_add");
    }
    for (const rcl_service_t & service : node.services) {
      check(rcl_wait_set_add_service(&wait_set, &service, nullptr), "rcl_wait_set_add");
    }
  }
  check(rcl_wait_set_add_guard_condition(&wait_set, &end, nullptr), "rcl_wait_set_add");
  check(rcl_wait(&wait_set, -1), "rcl_wait");
  if (wait_set.guard_conditions[0] == nullptr) {
    throw std::runtime_error("a node of the fleet woke up, and nothing was sent to it");
  }
  check(rcl_wait_set_fini(&wait_set), "rcl_wait_set_fini");
}

void run(const Arguments & arguments) {
  Context context;
  Fleet fleet;
  std::vector<int64_t> samples_ns;
  const size_t first = arguments.number("first");
  for (size_t i = first; i < first + arguments.number("nodes"); ++i) {
    const int64_t start_ns = monotonic_ns();
    fleet.emplace_back(context.get(), i, arguments.number("all"));
    samples_ns.push_back(monotonic_ns() - start_ns);
  }
  rcl_guard_condition_t end = rcl_get_zero_initialized_guard_condition();
  check(
    rcl_guard_condition_init(&end, &context.get(), rcl_guard_condition_get_default_options()),
    "rcl_guard_condition_init");
  std::thread waiter([&] { wait_for_anything(context, fleet, end); });
  for (const FleetNode & node : fleet) {
    while (arguments.number("all") != 0 && !node.is_matched()) {
      std::this_thread::sleep_for(look_again_after);
    }
  }
  announce_ready();
  wait_for_end_of_input();
  check(rcl_trigger_guard_condition(&end), "rcl_trigger_guard_condition");
  waiter.join();
  check(rcl_guard_condition_fini(&end), "rcl_guard_condition_fini");
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
