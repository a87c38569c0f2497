// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/node.hpp"

#include <rcutils/strdup.h>
#include <rmw/error_handling.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace manycore::bench {
namespace {

size_t domain_of_environment() {
  const char * domain = std::getenv("ROS_DOMAIN_ID");
  return domain == nullptr ? 0 : std::stoul(domain);
}

const rosidl_message_type_support_t * type_support() {
  return rosidl_typesupport_cpp::get_message_type_support_handle<Message>();
}

[[noreturn]] void fail(const char * what) {
  const std::string reason = rmw_get_error_string().str;
  rmw_reset_error();
  throw std::runtime_error(std::string(what) + " failed: " + reason);
}

/// For destructors, which must not throw.
void warn_unless_ok(rmw_ret_t status, const char * what) {
  if (status != RMW_RET_OK) {
    std::fprintf(stderr, "%s failed: %s\n", what, rmw_get_error_string().str);
    rmw_reset_error();
  }
}

template<typename Entity>
Entity * created(Entity * entity, const char * what) {
  if (entity == nullptr) {
    fail(what);
  }
  return entity;
}

constexpr auto stop_again_after = std::chrono::seconds(1);

/// Returns false if the condition does not hold within `time`.
template<typename Condition>
bool poll_for(std::chrono::milliseconds time, Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

template<typename Condition>
void poll(Condition condition, const char * what) {
  if (!poll_for(timeout, condition)) {
    throw std::runtime_error(std::string("no ") + what);
  }
}

}  // namespace

void check(rmw_ret_t status, const char * what) {
  if (status != RMW_RET_OK) {
    fail(what);
  }
}

rmw_qos_profile_t reliable_qos(size_t depth) {
  rmw_qos_profile_t qos = rmw_qos_profile_default;
  qos.depth = depth;
  return qos;
}

rmw_qos_profile_t latched_qos() {
  rmw_qos_profile_t qos = reliable_qos(1);
  qos.durability = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
  return qos;
}

Node::Node(const std::string & name)
: options_(rmw_get_zero_initialized_init_options()), context_(rmw_get_zero_initialized_context()) {
  check(rmw_init_options_init(&options_, rcutils_get_default_allocator()), "rmw_init_options_init");
  options_.domain_id = domain_of_environment();
  options_.discovery_options.automatic_discovery_range = RMW_AUTOMATIC_DISCOVERY_RANGE_SUBNET;
  options_.enclave = rcutils_strdup("/", options_.allocator);
  check(rmw_init(&options_, &context_), "rmw_init");
  node_ = created(rmw_create_node(&context_, name.c_str(), "/bench"), "rmw_create_node");
}

Node::~Node() {
  warn_unless_ok(rmw_destroy_node(node_), "rmw_destroy_node");
  warn_unless_ok(rmw_shutdown(&context_), "rmw_shutdown");
  warn_unless_ok(rmw_context_fini(&context_), "rmw_context_fini");
  warn_unless_ok(rmw_init_options_fini(&options_), "rmw_init_options_fini");
}

Publisher::Publisher(Node & node, const std::string & topic, const rmw_qos_profile_t & qos)
: node_(node) {
  const rmw_publisher_options_t options = rmw_get_default_publisher_options();
  publisher_ = created(
    rmw_create_publisher(node.handle(), type_support(), topic.c_str(), &qos, &options),
    "rmw_create_publisher");
}

Publisher::~Publisher() {
  warn_unless_ok(rmw_destroy_publisher(node_.handle(), publisher_), "rmw_destroy_publisher");
}

void Publisher::publish(const Message & message) {
  check(rmw_publish(publisher_, &message, nullptr), "rmw_publish");
}

size_t Publisher::matched() const {
  size_t count = 0;
  check(
    rmw_publisher_count_matched_subscriptions(publisher_, &count),
    "rmw_publisher_count_matched_subscriptions");
  return count;
}

Subscription::Subscription(Node & node, const std::string & topic, const rmw_qos_profile_t & qos)
: node_(node) {
  const rmw_subscription_options_t options = rmw_get_default_subscription_options();
  subscription_ = created(
    rmw_create_subscription(node.handle(), type_support(), topic.c_str(), &qos, &options),
    "rmw_create_subscription");
}

Subscription::~Subscription() {
  warn_unless_ok(
    rmw_destroy_subscription(node_.handle(), subscription_), "rmw_destroy_subscription");
}

bool Subscription::take(Message & message) {
  bool taken = false;
  check(rmw_take(subscription_, &message, &taken, nullptr), "rmw_take");
  return taken;
}

size_t Subscription::matched() const {
  size_t count = 0;
  check(
    rmw_subscription_count_matched_publishers(subscription_, &count),
    "rmw_subscription_count_matched_publishers");
  return count;
}

WaitSet::WaitSet(Node & node)
: wait_set_(created(rmw_create_wait_set(node.context(), 2), "rmw_create_wait_set")) {}

WaitSet::~WaitSet() { warn_unless_ok(rmw_destroy_wait_set(wait_set_), "rmw_destroy_wait_set"); }

bool WaitSet::wait(
  const Subscription & subscription, std::optional<std::chrono::milliseconds> timeout,
  rmw_guard_condition_t * guard_condition) {
  void * subscription_data[] = {subscription.data()};
  void * guard_data[] = {guard_condition == nullptr ? nullptr : guard_condition->data};
  rmw_subscriptions_t subscriptions{1, subscription_data};
  rmw_guard_conditions_t guard_conditions{guard_condition == nullptr ? 0U : 1U, guard_data};
  rmw_time_t time{};
  if (timeout) {
    time.sec = static_cast<uint64_t>(timeout->count() / 1000);
    time.nsec = static_cast<uint64_t>(timeout->count() % 1000) * 1'000'000;
  }
  const rmw_ret_t status = rmw_wait(
    &subscriptions, &guard_conditions, nullptr, nullptr, nullptr, wait_set_,
    timeout ? &time : nullptr);
  if (status == RMW_RET_TIMEOUT) {
    return false;
  }
  check(status, "rmw_wait");
  return true;
}

void take_next(WaitSet & wait_set, Subscription & subscription, Message & message) {
  do {
    if (!wait_set.wait(subscription, timeout)) {
      throw std::runtime_error("no message arrived within 60 s");
    }
  } while (!subscription.take(message));
}

void wait_until_matched(const Publisher & publisher, const Subscription & subscription) {
  poll([&] { return publisher.matched() > 0 && subscription.matched() > 0; }, "peer to talk to");
}

void wait_until_matched(const Publisher & publisher, size_t subscriptions) {
  poll([&] { return publisher.matched() >= subscriptions; }, "subscription to publish to");
}

void stop_subscribers(Publisher & publisher) {
  const auto are_gone = [&] { return publisher.matched() == 0; };
  const auto stop = [&] {  // repeated, because best effort may lose it
    publisher.publish(Message());
    return poll_for(stop_again_after, are_gone);
  };
  poll(stop, "end of the subscribers");
}

void set_number(Message & message, uint64_t number) {
  std::memcpy(message.data.data(), &number, sizeof number);
}

uint64_t number_of(const Message & message) {
  uint64_t number = 0;
  std::memcpy(&number, message.data.data(), sizeof number);
  return number;
}

}  // namespace manycore::bench
