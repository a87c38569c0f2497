// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "messages.hpp"

#include <numeric>
#include <utility>

#include "platform/clock.hpp"
#include "waiting.hpp"

using namespace manycore;

Qos keep_last(uint32_t depth) {
  Qos qos;
  qos.depth = depth;
  return qos;
}

Qos keep_all() {
  Qos qos;
  qos.history = History::keep_all;
  return qos;
}

Qos best_effort(uint32_t depth) {
  Qos qos = keep_last(depth);
  qos.reliability = Reliability::best_effort;
  return qos;
}

Qos transient_local(uint32_t depth) {
  Qos qos = keep_last(depth);
  qos.durability = Durability::transient_local;
  return qos;
}

EndpointSpec on_topic(const std::string & topic, const Qos & qos) {
  EndpointSpec spec;
  spec.topic = topic;
  spec.type = "test_msgs/msg/Payload";
  spec.qos = qos;
  return spec;
}

uint64_t publish(Publisher & publisher, uint64_t number, size_t size_bytes, uint64_t writer) {
  Draft draft = publisher.draft(size_bytes);
  Payload{writer, number, size_bytes}.write(draft.data());
  return publisher.publish(std::move(draft), size_bytes, realtime_ns());
}

std::optional<Payload> take(Subscription & subscription) {
  const std::optional<Claim> claim = subscription.claim();
  if (!claim) {
    return std::nullopt;
  }
  return Payload::read(claim->data(), claim->size());
}

Payload take_next(Process & process, Subscription & subscription) {
  const int64_t end = monotonic_ns() + timeout_s * ns_per_s;
  while (true) {
    const uint32_t epoch = process.waiters().common().epoch();
    if (const std::optional<Payload> payload = take(subscription)) {
      return *payload;
    }
    if (!process.waiters().common().wait(epoch, end)) {
      throw std::runtime_error("no message arrives");
    }
  }
}

std::vector<uint64_t> take_all(Subscription & subscription) {
  std::vector<uint64_t> taken;
  while (const std::optional<Payload> payload = take(subscription)) {
    taken.push_back(payload->number);
  }
  return taken;
}

std::vector<uint64_t> numbers(uint64_t first, uint64_t last) {
  std::vector<uint64_t> all(last - first + 1);
  std::iota(all.begin(), all.end(), first);
  return all;
}
