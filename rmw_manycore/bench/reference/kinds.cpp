// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/kinds.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bench/reference/crunch.hpp"
#include "bench/reference/sample_path.hpp"

namespace manycore::bench::reference {

Kind::Kind(RclNode & node, const Settings & settings) : settings_(settings) {
  for (const std::string & topic : settings.inputs) {
    inputs_.emplace_back(node, topic, settings.ports);
  }
  for (const std::string & topic : settings.outputs) {
    outputs_.emplace_back(node, settings.name, topic, settings.ports);
  }
}

void Kind::publish_cached(uint64_t timestamp_ns) {
  const int64_t result = crunch(settings_.crunch_ns);
  std::vector<Input *> cached;
  for (Input & input : inputs_) {
    if (input.is_cached) {
      cached.push_back(&input);
    }
  }
  outputs_.front().publish(timestamp_ns, cached, result);
  for (Input * input : cached) {
    input->is_cached = false;
  }
}

namespace {

/// Publishes its own record in each period.
class Sensor : public Kind {
public:
  using Kind::Kind;
  std::optional<std::chrono::milliseconds> period() const override { return settings_.period; }
  void tick() override { outputs_.front().publish(system_now_ns()); }
};

/// Publishes one message for each received one.
class Transform : public Kind {
public:
  using Kind::Kind;
  void receive(size_t input) override {
    const uint64_t timestamp_ns = system_now_ns();
    inputs_[input].is_cached = true;
    publish_cached(timestamp_ns);
  }
};

/// Publishes once all inputs have arrived, with the newest message of each.
class Fusion : public Kind {
public:
  using Kind::Kind;
  void receive(size_t input) override {
    const uint64_t timestamp_ns = system_now_ns();
    inputs_[input].is_cached = true;
    if (std::all_of(
          inputs_.begin(), inputs_.end(), [](const Input & each) { return each.is_cached; })) {
      publish_cached(timestamp_ns);
    }
  }
};

/// Publishes in each period, with the newest message of each input that has arrived in it.
class Cyclic : public Kind {
public:
  using Kind::Kind;
  std::optional<std::chrono::milliseconds> period() const override { return settings_.period; }
  void receive(size_t input) override { inputs_[input].is_cached = true; }
  void tick() override { publish_cached(system_now_ns()); }
};

/// Several transforms in one node: the first input leads to the first output, and so on.
class Intersection : public Kind {
public:
  using Kind::Kind;
  void receive(size_t input) override {
    const uint64_t timestamp_ns = system_now_ns();
    const int64_t result = crunch(settings_.crunch_ns);
    outputs_.at(input).publish(timestamp_ns, {&inputs_[input]}, result);
  }
};

/// Prints path and statistics of the received messages.
class Command : public Kind {
public:
  Command(RclNode & node, const Settings & settings) : Kind(node, settings), path_(settings.name) {}
  void receive(size_t input) override {
    const uint64_t timestamp_ns = system_now_ns();
    const uint32_t missed = inputs_[input].missed();
    if (timestamp_ns >= reported_ns_ + settings_.report_period_ns) {
      reported_ns_ = timestamp_ns;
      const std::string text = path_.add(inputs_[input].message(), timestamp_ns, missed);
      std::fwrite(text.data(), 1, text.size(), stdout);
      std::fflush(stdout);
    }
  }

private:
  SamplePath path_;
  uint64_t reported_ns_ = 0;
};

}  // namespace

std::unique_ptr<Kind> make_kind(RclNode & node, const Settings & settings) {
  const std::string & kind = settings.kind;
  if (kind == "sensor") {
    return std::make_unique<Sensor>(node, settings);
  }
  if (kind == "transform") {
    return std::make_unique<Transform>(node, settings);
  }
  if (kind == "fusion") {
    return std::make_unique<Fusion>(node, settings);
  }
  if (kind == "cyclic") {
    return std::make_unique<Cyclic>(node, settings);
  }
  if (kind == "intersection") {
    return std::make_unique<Intersection>(node, settings);
  }
  if (kind == "command") {
    return std::make_unique<Command>(node, settings);
  }
  throw std::invalid_argument("unknown kind " + kind);
}

}  // namespace manycore::bench::reference
