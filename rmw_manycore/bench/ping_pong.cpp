// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/ping_pong.hpp"

#include "platform/clock.hpp"

namespace manycore::bench {
namespace {

constexpr size_t depth = 10;
constexpr std::chrono::milliseconds hello_period{100};

}  // namespace

Ping::Ping(size_t bytes)
: publisher_(node_, "/ping", reliable_qos(depth)),
  subscription_(node_, "/pong", reliable_qos(depth)) {
  sent_.data.resize(bytes);
}

void Ping::connect() {
  wait_until_matched(publisher_, subscription_);
  // The other side may not have matched these endpoints yet, so its first answers can be lost.
  set_number(sent_, 0);
  do {
    publisher_.publish(sent_);
  } while (!wait_set_.wait(subscription_, hello_period));
}

int64_t Ping::round_trip() {
  set_number(sent_, ++number_);
  const int64_t start_ns = monotonic_ns();
  publisher_.publish(sent_);
  do {
    take_next(wait_set_, subscription_, received_);
  } while (number_of(received_) != number_);
  return monotonic_ns() - start_ns;
}

void Ping::stop() { stop_subscribers(publisher_); }

void run_pong(const std::function<void(uint64_t number)> & before) {
  Node node("pong");
  Publisher publisher(node, "/pong", reliable_qos(depth));
  Subscription subscription(node, "/ping", reliable_qos(depth));
  WaitSet wait_set(node);
  Message message;
  while (true) {
    take_next(wait_set, subscription, message);
    if (message.data.empty()) {
      return;
    }
    before(number_of(message));
    publisher.publish(message);
  }
}

}  // namespace manycore::bench
