// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/reference/ports.hpp"

namespace manycore::bench::reference {

/// Parameters of a node of the reference system.
struct Settings {
  std::string name;
  std::string kind;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  std::chrono::milliseconds period;
  int64_t crunch_ns;
  uint64_t report_period_ns;
  PortOptions ports;
};

/// A node of the reference system with its callbacks, which an executor calls.
class Kind {
public:
  Kind(RclNode & node, const Settings & settings);
  Kind(const Kind &) = delete;
  Kind & operator=(const Kind &) = delete;
  virtual ~Kind() = default;

  std::deque<Input> & inputs() { return inputs_; }
  /// Timer period, if the kind has a timer.
  virtual std::optional<std::chrono::milliseconds> period() const { return std::nullopt; }

  /// Called after a message was taken from `input`, which holds it.
  virtual void receive(size_t /*input*/) {}
  virtual void tick() {}

protected:
  /// Computes, publishes the cached messages of the inputs, and clears the cache.
  void publish_cached(uint64_t timestamp_ns);

  const Settings settings_;
  std::deque<Input> inputs_;
  std::deque<Output> outputs_;
};

/// Creates the kind named `settings.kind`, with the rules of ros-realtime/reference-system.
std::unique_ptr<Kind> make_kind(RclNode & node, const Settings & settings);

}  // namespace manycore::bench::reference
