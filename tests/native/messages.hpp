// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "payload.hpp"
#include "transport/process.hpp"

manycore::Qos keep_last(uint32_t depth);
manycore::Qos keep_all();
manycore::Qos best_effort(uint32_t depth);
manycore::Qos transient_local(uint32_t depth);
manycore::EndpointSpec on_topic(const std::string & topic, const manycore::Qos & qos);

/// Publishes message `number` of `writer`; returns the publication sequence number.
uint64_t publish(
  manycore::Publisher & publisher, uint64_t number, size_t size_bytes = sizeof(Payload),
  uint64_t writer = 1);

/// The next message, if there is one. Throws if it is torn.
std::optional<Payload> take(manycore::Subscription & subscription);
/// Waits for the next message. Throws if none arrives.
Payload take_next(manycore::Process & process, manycore::Subscription & subscription);
/// Takes all available messages; returns their numbers.
std::vector<uint64_t> take_all(manycore::Subscription & subscription);

/// first, first + 1, .. last
std::vector<uint64_t> numbers(uint64_t first, uint64_t last);
