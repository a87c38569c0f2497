// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The skeleton of a node at the rcl level: its publishers and subscriptions without its work.
//
//   skeleton_node name=NAME publishers=TOPIC:DEPTH:BYTES:PERIOD_US:SUBSCRIPTIONS,...
//     subscriptions=TOPIC:DEPTH:PUBLISHERS,...
//
// NAME is full. Prints "ready" when each publisher has matched SUBSCRIPTIONS and each subscription
// PUBLISHERS. Between the lines "publish" and "stop" of its input, each publisher publishes every
// PERIOD_US, or never if that is 0. After the line "count" it prints what its publishers owed to
// subscriptions so far, and how many messages it received. Ends when its input ends. "published"
// counts the messages, "due" what is owed; the samples are the ages of received messages.
#include <rosidl_runtime_c/primitives_sequence_functions.h>
#include <std_msgs/msg/u_int8_multi_array.h>

#include <algorithm>
#include <atomic>
#include <cinttypes>
#include <cstring>
#include <functional>
#include <iostream>
#include <thread>
#include <utility>

#include "bench/program.hpp"
#include "bench/rcl_node.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;
using Message = std_msgs__msg__UInt8MultiArray;

// All processes ask; that must leave most of the CPUs to those that still start.
constexpr auto poll_period = std::chrono::milliseconds(200);

enum class Phase : uint8_t { resting, publishing, over };

class OwnMessage {
public:
  OwnMessage() {
    if (!std_msgs__msg__UInt8MultiArray__init(&message_)) {
      throw std::bad_alloc();
    }
  }
  OwnMessage(const OwnMessage &) = delete;
  OwnMessage & operator=(const OwnMessage &) = delete;
  ~OwnMessage() { std_msgs__msg__UInt8MultiArray__fini(&message_); }
  Message & get() { return message_; }

private:
  Message message_{};
};

rmw_qos_profile_t qos_of(const std::string & depth) {
  rmw_qos_profile_t qos = rmw_qos_profile_default;
  qos.depth = std::stoul(depth);
  return qos;
}

std::vector<std::string> split(const std::string & text) {
  std::vector<std::string> parts;
  std::istringstream words(text);
  for (std::string part; std::getline(words, part, ':');) {
    parts.push_back(part);
  }
  return parts;
}

const rosidl_message_type_support_t * type() {
  return ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, UInt8MultiArray);
}

/// A publisher and when it publishes next.
class Output {
public:
  Output(RclNode & node, const std::vector<std::string> & parts)
  : publisher_(node.publish(parts.at(0), type(), qos_of(parts.at(1)))),
    period_ns_(std::stoll(parts.at(3)) * 1000),
    subscriptions_(std::stoul(parts.at(4))) {
    if (!rosidl_runtime_c__uint8__Sequence__init(
          &message_.get().data, std::max<size_t>(std::stoul(parts.at(2)), sizeof(int64_t)))) {
      throw std::bad_alloc();
    }
  }

  bool is_matched() const {
    size_t count = 0;
    check_rcl(rcl_publisher_get_subscription_count(&publisher_, &count), "subscription count");
    return count >= subscriptions_;
  }

  /// Publishers of the same period must not all be due at one moment: `phase` is below 1.
  void start(int64_t now_ns, double phase) {
    due_ns_ = period_ns_ == 0
                ? INT64_MAX
                : now_ns + static_cast<int64_t>(phase * static_cast<double>(period_ns_));
  }

  /// Publishes if it is time to, and leaves out what a busy CPU made it miss, as a timer does.
  bool publish_if_due(int64_t now_ns) {
    if (now_ns < due_ns_) {
      return false;
    }
    due_ns_ += ((now_ns - due_ns_) / period_ns_ + 1) * period_ns_;
    std::memcpy(message_.get().data.data, &now_ns, sizeof now_ns);
    check_rcl(rcl_publish(&publisher_, &message_.get(), nullptr), "rcl_publish");
    return true;
  }

  int64_t due_ns() const { return due_ns_; }
  size_t subscriptions() const { return subscriptions_; }

private:
  rcl_publisher_t & publisher_;
  const int64_t period_ns_;
  const size_t subscriptions_;
  int64_t due_ns_ = INT64_MAX;
  OwnMessage message_;
};

class Input {
public:
  Input(RclNode & node, const std::vector<std::string> & parts)
  : subscription_(node.subscribe(parts.at(0), type(), qos_of(parts.at(1)))),
    publishers_(std::stoul(parts.at(2))) {}

  bool is_matched() const {
    size_t count = 0;
    check_rcl(rcl_subscription_get_publisher_count(&subscription_, &count), "publisher count");
    return count >= publishers_;
  }

  const rcl_subscription_t & subscription() const { return subscription_; }

private:
  rcl_subscription_t & subscription_;
  const size_t publishers_;
};

/// A node with one thread that publishes and takes, as SingleThreadedExecutor does.
class Skeleton {
public:
  explicit Skeleton(const Arguments & arguments)
  : node_(context_.get(), arguments.text("name")), changed_(context_) {
    for (const std::string & each : arguments.list("publishers")) {
      outputs_.emplace_back(node_, split(each));
    }
    for (const std::string & each : arguments.list("subscriptions")) {
      inputs_.emplace_back(node_, split(each));
    }
    name_hash_ = std::hash<std::string>()(arguments.text("name"));
  }

  bool is_matched() const {
    const auto matched = [](const auto & each) { return each.is_matched(); };
    return std::all_of(outputs_.begin(), outputs_.end(), matched) &&
           std::all_of(inputs_.begin(), inputs_.end(), matched);
  }

  /// From any thread.
  void enter(Phase phase) {
    phase_ = phase;
    changed_.trigger();
  }

  /// From any thread. What was entered before is in the counts.
  void ask_for_counts() {
    is_asked_ = true;
    changed_.trigger();
  }

  void spin() {
    RclWaitSet wait_set(context_.get(), {&node_}, changed_);
    Phase last = Phase::resting;
    for (Phase phase = phase_; phase != Phase::over; phase = phase_) {
      if (phase == Phase::publishing && last != phase) {
        start();
      }
      last = phase;
      wait_set.wait(phase == Phase::publishing ? publish_due() : forever);
      take_all(wait_set);
      if (is_asked_.exchange(false)) {
        std::printf("%" PRIu64 " %zu\n", due_, ages_ns_.size());
        std::fflush(stdout);
      }
    }
  }

  void print_counts() const { print_samples(ages_ns_, {{"published", published_}, {"due", due_}}); }

private:
  static constexpr int64_t forever = -1;

  void start() {
    constexpr double spread = 0.618033988749895;  // multiples of it are far from each other
    const int64_t now_ns = monotonic_ns();
    double phase = static_cast<double>(name_hash_ % 1000) / 1000;
    for (Output & output : outputs_) {
      phase = phase + spread < 1 ? phase + spread : phase + spread - 1;
      output.start(now_ns, phase);
    }
  }

  /// Returns the nanoseconds until the next publication.
  int64_t publish_due() {
    int64_t next_ns = INT64_MAX;
    for (Output & output : outputs_) {
      if (output.publish_if_due(monotonic_ns())) {
        ++published_;
        due_ += output.subscriptions();
      }
      next_ns = std::min(next_ns, output.due_ns());
    }
    return next_ns == INT64_MAX ? forever : std::max<int64_t>(next_ns - monotonic_ns(), 0);
  }

  void take_all(const RclWaitSet & wait_set) {
    wait_set.for_each_ready_subscription([&](const rcl_subscription_t & subscription) {
      const auto is_it = [&](const Input & input) {
        return &input.subscription() == &subscription;
      };
      if (std::none_of(inputs_.begin(), inputs_.end(), is_it)) {
        take_parameter_event(subscription);
        return;
      }
      while (take(subscription)) {
      }
    });
  }

  bool take(const rcl_subscription_t & subscription) {
    const rcl_ret_t status = rcl_take(&subscription, &taken_.get(), nullptr, nullptr);
    if (status == RCL_RET_SUBSCRIPTION_TAKE_FAILED) {
      return false;
    }
    check_rcl(status, "rcl_take");
    int64_t sent_ns = 0;
    std::memcpy(&sent_ns, taken_.get().data.data, sizeof sent_ns);
    ages_ns_.push_back(monotonic_ns() - sent_ns);
    return true;
  }

  RclContext context_;
  RclNode node_;
  RclGuardCondition changed_;
  std::deque<Output> outputs_;
  std::deque<Input> inputs_;
  size_t name_hash_ = 0;
  std::atomic<Phase> phase_{Phase::resting};
  std::atomic<bool> is_asked_{false};
  OwnMessage taken_;
  std::vector<int64_t> ages_ns_;
  uint64_t published_ = 0;
  uint64_t due_ = 0;
};

void run(const Arguments & arguments) {
  Skeleton skeleton(arguments);
  std::thread spinning([&] { skeleton.spin(); });
  while (!skeleton.is_matched()) {
    std::this_thread::sleep_for(poll_period);
  }
  announce_ready();
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "count") {
      skeleton.ask_for_counts();
    } else {
      skeleton.enter(line == "publish" ? Phase::publishing : Phase::resting);
    }
  }
  skeleton.enter(Phase::over);
  spinning.join();
  skeleton.print_counts();
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
