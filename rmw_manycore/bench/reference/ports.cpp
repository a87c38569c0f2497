// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/ports.hpp"

#include <rcl/error_handling.h>
#include <rmw/qos_profiles.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "bench/reference/interruption.hpp"

namespace manycore::bench::reference {

namespace {

// Rate limit of loss reports, so that they cost a flooded node little.
constexpr uint64_t losses_said_every_ns = 100'000'000;
// KEEP_ALL blocks for a while and then refuses; subscribers that have not taken for this long are
// dead.
constexpr std::chrono::seconds timeout{20};

rmw_qos_profile_t qos_of(size_t depth) {
  rmw_qos_profile_t qos = rmw_qos_profile_default;
  qos.depth = depth;
  qos.history = depth == 0 ? RMW_QOS_POLICY_HISTORY_KEEP_ALL : RMW_QOS_POLICY_HISTORY_KEEP_LAST;
  return qos;
}

}  // namespace

Input::Input(RclNode & node, std::string topic, const PortOptions & options)
: topic_(std::move(topic)),
  options_(options),
  message_(options.type.bytes),
  subscription_(node.subscribe(topic_, options.type.support, qos_of(options.depth))) {}

bool Input::take() {
  rmw_message_info_t info = rmw_get_zero_initialized_message_info();
  const rcl_ret_t status = rcl_take(&subscription_, &message_.get(), &info, nullptr);
  if (status == RCL_RET_SUBSCRIPTION_TAKE_FAILED) {
    rcl_reset_error();
    return false;
  }
  check_rcl(status, "rcl_take");
  lost_ += received_.before(sequence_of(message_.get()));
  if (lost_ > 0 && system_now_ns() > said_ns_ + losses_said_every_ns) {
    say_losses();
  }
  if (options_.is_checked) {
    check_payload(message_.get(), options_.type, topic_);
  }
  return true;
}

void Input::say_losses() {
  if (lost_ > 0) {
    said_ns_ = system_now_ns();
    std::printf(
      "lost %llu of %s at %llu\n", static_cast<unsigned long long>(lost_), topic_.c_str(),
      static_cast<unsigned long long>(said_ns_));
    std::fflush(stdout);
    lost_ = 0;
  }
}

Output::Output(
  RclNode & node, std::string node_name, const std::string & topic, const PortOptions & options)
: node_name_(std::move(node_name)),
  options_(options),
  publisher_(node.publish(topic, options.type.support, qos_of(options.depth))),
  lends_(rcl_publisher_can_loan_messages(&publisher_)),
  own_(lends_ ? sizeof(Message) : options.type.bytes) {}

void Output::publish(uint64_t timestamp_ns, const std::vector<Input *> & sources, int64_t result) {
  if (!lends_) {
    fill(own_.get(), timestamp_ns, sources, result);
    until_published([&] { return rcl_publish(&publisher_, &own_.get(), nullptr); });
    return;
  }
  void * loan = nullptr;
  check_rcl(
    rcl_borrow_loaned_message(&publisher_, options_.type.support, &loan),
    "rcl_borrow_loaned_message");
  fill(*static_cast<Message *>(loan), timestamp_ns, sources, result);
  until_published([&] { return rcl_publish_loaned_message(&publisher_, loan, nullptr); });
}

void Output::fill(
  Message & message, uint64_t timestamp_ns, const std::vector<Input *> & sources, int64_t result) {
  message.size = 0;
  uint32_t missed = 0;
  for (Input * source : sources) {
    missed += source->missed();
    merge_records(message, source->message());
  }
  add_record(message, node_name_, timestamp_ns, sequence_, missed);
  message.data[0] = result;
  if (options_.is_checked) {
    write_payload(message, options_.type, sequence_);
  }
  ++sequence_;
}

/// A KEEP_ALL publisher refuses messages while there is no room; the message stays with the caller.
template<typename Publish>
void Output::until_published(Publish publish) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  rcl_ret_t status = publish();
  while (status != RCL_RET_OK && options_.depth == 0 && !is_interrupted() &&
         std::chrono::steady_clock::now() < deadline) {
    rcl_reset_error();
    status = publish();
  }
  if (!is_interrupted()) {
    check_rcl(status, "publishing");
  }
}

}  // namespace manycore::bench::reference
