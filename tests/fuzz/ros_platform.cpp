// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ros_platform.hpp"

#include <stdexcept>

#include "rcutils/allocator.h"
#include "rcutils/strdup.h"
#include "rmw/error_handling.h"
#include "rmw/event.h"

namespace {

[[noreturn]] void fail(const char * what) {
  const std::string reason = rmw_get_error_string().str;
  rmw_reset_error();
  throw std::runtime_error(std::string(what) + ": " + reason);
}

template<typename Handle>
Handle * created(Handle * handle, const char * what) {
  if (handle == nullptr) {
    fail(what);
  }
  return handle;
}

/// For destructors: a failure shows up as a leak.
void ignore(rmw_ret_t) {}

}  // namespace

void check(rmw_ret_t code, const char * what) {
  if (code != RMW_RET_OK) {
    fail(what);
  }
}

Node::Node()
: options_(rmw_get_zero_initialized_init_options()), context_(rmw_get_zero_initialized_context()) {
  check(rmw_init_options_init(&options_, rcutils_get_default_allocator()), "rmw_init_options_init");
  options_.enclave = rcutils_strdup("/", options_.allocator);
  check(rmw_init(&options_, &context_), "rmw_init");
  node_ = created(rmw_create_node(&context_, "fuzz", "/"), "rmw_create_node");
}

Node::~Node() {
  ignore(rmw_destroy_node(node_));
  ignore(rmw_shutdown(&context_));
  ignore(rmw_context_fini(&context_));
  ignore(rmw_init_options_fini(&options_));
}

Topic::Topic(const Node & node, const std::string & name, const MessageType & type)
: node_(node), lost_event_(rmw_get_zero_initialized_event()) {
  const rmw_publisher_options_t offered = rmw_get_default_publisher_options();
  const rmw_subscription_options_t requested = rmw_get_default_subscription_options();
  const rmw_qos_profile_t & qos = rmw_qos_profile_default;
  publisher_ = created(
    rmw_create_publisher(node.handle(), type.support(), name.c_str(), &qos, &offered),
    "rmw_create_publisher");
  subscription_ = created(
    rmw_create_subscription(node.handle(), type.support(), name.c_str(), &qos, &requested),
    "rmw_create_subscription");
  check(
    rmw_subscription_event_init(&lost_event_, subscription_, RMW_EVENT_MESSAGE_LOST),
    "rmw_subscription_event_init");
}

Topic::~Topic() {
  ignore(rmw_event_fini(&lost_event_));
  ignore(rmw_destroy_subscription(node_.handle(), subscription_));
  ignore(rmw_destroy_publisher(node_.handle(), publisher_));
}

void Topic::publish(const std::vector<uint8_t> & cdr) {
  rmw_serialized_message_t message = rmw_get_zero_initialized_serialized_message();
  message.buffer = const_cast<uint8_t *>(cdr.data());  // never written
  message.buffer_length = message.buffer_capacity = cdr.size();
  check(rmw_publish_serialized_message(publisher_, &message, nullptr), "publish");
}

bool Topic::take(void * message) {
  bool taken = false;
  check(rmw_take(subscription_, message, &taken, nullptr), "rmw_take");
  return taken;
}

uint64_t Topic::lost() {
  rmw_message_lost_status_t status{};
  bool taken = false;
  check(rmw_take_event(&lost_event_, &status, &taken), "rmw_take_event");
  return status.total_count;
}
