// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/rcl_node.hpp"

#include <rcl/error_handling.h>
#include <rcl/logging_rosout.h>
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

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace manycore::bench {

void check_rcl(rcl_ret_t status, const char * what) {
  if (status != RCL_RET_OK) {
    const std::string reason = rcl_get_error_string().str;
    rcl_reset_error();
    throw std::runtime_error(std::string(what) + " failed: " + reason);
  }
}

void report_rcl(rcl_ret_t status) {
  if (status != RCL_RET_OK) {
    std::fprintf(stderr, "%s\n", rcl_get_error_string().str);
    rcl_reset_error();
  }
}

void take_parameter_event(const rcl_subscription_t & subscription) {
  rcl_interfaces__msg__ParameterEvent message;
  rcl_interfaces__msg__ParameterEvent__init(&message);
  const rcl_ret_t status = rcl_take(&subscription, &message, nullptr, nullptr);
  if (status != RCL_RET_SUBSCRIPTION_TAKE_FAILED) {
    check_rcl(status, "rcl_take");
  }
  rcl_interfaces__msg__ParameterEvent__fini(&message);
}

namespace {

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

}  // namespace

RclContext::RclContext() {
  rcl_init_options_t options = rcl_get_zero_initialized_init_options();
  check_rcl(rcl_init_options_init(&options, rcl_get_default_allocator()), "rcl_init_options_init");
  check_rcl(rcl_init(0, nullptr, &options, &context_), "rcl_init");
  check_rcl(rcl_init_options_fini(&options), "rcl_init_options_fini");
}

RclContext::~RclContext() {
  report_rcl(rcl_shutdown(&context_));
  report_rcl(rcl_context_fini(&context_));
}

RclGuardCondition::RclGuardCondition(RclContext & context) {
  check_rcl(
    rcl_guard_condition_init(
      &condition_, &context.get(), rcl_guard_condition_get_default_options()),
    "rcl_guard_condition_init");
}

RclNode::RclNode(rcl_context_t & context, const std::string & name) {
  const rcl_node_options_t options = rcl_node_get_default_options();
  const size_t slash = name.rfind('/');
  const std::string base = slash == std::string::npos ? name : name.substr(slash + 1);
  const std::string space = slash == std::string::npos ? "" : name.substr(0, slash);
  check_rcl(
    rcl_node_init(&node_, base.c_str(), space.c_str(), &context, &options), "rcl_node_init");
  const auto * const log = ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, Log);
  const auto * const event = ROSIDL_GET_MSG_TYPE_SUPPORT(rcl_interfaces, msg, ParameterEvent);
  publish("/rosout", log, rcl_qos_profile_rosout_default);
  publish("/parameter_events", event, rmw_qos_profile_parameter_events);
  subscribe("/parameter_events", event, rmw_qos_profile_parameter_events);
  for (const ServiceKind & kind : services_of_a_node()) {
    serve(kind.name, kind.type);
  }
}

RclNode::~RclNode() {
  for (rcl_service_t & service : services_) {
    report_rcl(rcl_service_fini(&service, &node_));
  }
  for (rcl_client_t & client : clients_) {
    report_rcl(rcl_client_fini(&client, &node_));
  }
  for (rcl_subscription_t & subscription : subscriptions_) {
    report_rcl(rcl_subscription_fini(&subscription, &node_));
  }
  for (rcl_publisher_t & publisher : publishers_) {
    report_rcl(rcl_publisher_fini(&publisher, &node_));
  }
  report_rcl(rcl_node_fini(&node_));
}

rcl_publisher_t & RclNode::publish(
  const std::string & topic, const rosidl_message_type_support_t * type,
  const rmw_qos_profile_t & qos) {
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = qos;
  rcl_publisher_t publisher = rcl_get_zero_initialized_publisher();
  check_rcl(
    rcl_publisher_init(&publisher, &node_, type, topic.c_str(), &options), "rcl_publisher_init");
  return publishers_.emplace_back(publisher);
}

rcl_subscription_t & RclNode::subscribe(
  const std::string & topic, const rosidl_message_type_support_t * type,
  const rmw_qos_profile_t & qos) {
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos;
  rcl_subscription_t subscription = rcl_get_zero_initialized_subscription();
  check_rcl(
    rcl_subscription_init(&subscription, &node_, type, topic.c_str(), &options),
    "rcl_subscription_init");
  return subscriptions_.emplace_back(subscription);
}

rcl_client_t & RclNode::call(const char * service, const rosidl_service_type_support_t * type) {
  const rcl_client_options_t options = rcl_client_get_default_options();
  rcl_client_t client = rcl_get_zero_initialized_client();
  check_rcl(rcl_client_init(&client, &node_, type, service, &options), "rcl_client_init");
  return clients_.emplace_back(client);
}

void RclNode::serve(const char * name, const rosidl_service_type_support_t * type) {
  const rcl_service_options_t options = rcl_service_get_default_options();
  rcl_service_t service = rcl_get_zero_initialized_service();
  check_rcl(rcl_service_init(&service, &node_, type, name, &options), "rcl_service_init");
  services_.push_back(service);
}

RclWaitSet::RclWaitSet(
  rcl_context_t & context, std::vector<const RclNode *> nodes, const RclGuardCondition & end,
  rcl_timer_t * timer)
: nodes_(std::move(nodes)), end_(end), timer_(timer) {
  size_t subscriptions = 0;
  size_t clients = 0;
  size_t services = 0;
  for (const RclNode * const node : nodes_) {
    subscriptions += node->subscriptions().size();
    clients += node->clients().size();
    services += node->services().size();
  }
  check_rcl(
    rcl_wait_set_init(
      &wait_set_, subscriptions, 1, timer_ == nullptr ? 0 : 1, clients, services, 0, &context,
      rcl_get_default_allocator()),
    "rcl_wait_set_init");
}

void RclWaitSet::add_all() {
  constexpr const char * what = "rcl_wait_set_add";
  for (const RclNode * const node : nodes_) {
    for (const rcl_subscription_t & subscription : node->subscriptions()) {
      check_rcl(rcl_wait_set_add_subscription(&wait_set_, &subscription, nullptr), what);
    }
    for (const rcl_client_t & client : node->clients()) {
      check_rcl(rcl_wait_set_add_client(&wait_set_, &client, nullptr), what);
    }
    for (const rcl_service_t & service : node->services()) {
      check_rcl(rcl_wait_set_add_service(&wait_set_, &service, nullptr), what);
    }
  }
  if (timer_ != nullptr) {
    check_rcl(rcl_wait_set_add_timer(&wait_set_, timer_, nullptr), what);
  }
  check_rcl(rcl_wait_set_add_guard_condition(&wait_set_, &end_.get(), nullptr), what);
}

void RclWaitSet::wait(int64_t timeout_ns) {
  check_rcl(rcl_wait_set_clear(&wait_set_), "rcl_wait_set_clear");
  add_all();
  const rcl_ret_t status = rcl_wait(&wait_set_, timeout_ns);
  if (status != RCL_RET_TIMEOUT) {  // also returned when the timer is due
    check_rcl(status, "rcl_wait");
  }
}

bool RclWaitSet::has_request() const {
  const auto * const begin = wait_set_.services;
  return std::any_of(begin, begin + wait_set_.size_of_services, [](const rcl_service_t * service) {
    return service != nullptr;
  });
}

bool RclWaitSet::is_ready(const rcl_subscription_t & subscription) const {
  const auto * const begin = wait_set_.subscriptions;
  const auto * const end = begin + wait_set_.size_of_subscriptions;
  return std::find(begin, end, &subscription) != end;
}

}  // namespace manycore::bench
