// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"

namespace drivers_of_test {

using namespace manycore;

constexpr uint64_t mebibyte = 1 << 20;

inline Profile profile_of(uint64_t smem_bytes) {
  Profile profile = host_profile();
  profile.smem_bytes = smem_bytes;
  return profile;
}

/// A platform with one process, in which publishers of a topic come and go.
struct Fixture {
  std::unique_ptr<Publisher> publisher(const Qos & qos = keep_last(10)) {
    return process->create_publisher(on_topic("/driver", qos));
  }
  std::vector<std::unique_ptr<Publisher>> publishers(size_t count) {
    std::vector<std::unique_ptr<Publisher>> created;
    for (size_t i = 0; i < count; ++i) {
      created.push_back(publisher());
    }
    return created;
  }
  std::unique_ptr<Subscription> subscription(const Qos & qos) {
    return process->create_subscription(on_topic("/driver", qos));
  }
  std::vector<std::unique_ptr<Subscription>> subscriptions(size_t count, const Qos & qos) {
    std::vector<std::unique_ptr<Subscription>> created;
    for (size_t i = 0; i < count; ++i) {
      created.push_back(subscription(qos));
    }
    return created;
  }
  /// Publishes `count` messages with the next numbers, and leaves.
  void drive(uint64_t count, size_t size_bytes = 1000) {
    const auto driver = publisher();
    for (uint64_t i = 0; i < count; ++i) {
      publish(*driver, ++published, size_bytes);
    }
  }

  TestPlatform platform;
  Configurator configurator{platform.name(), profile_of(32 * mebibyte), {}};
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  uint64_t published = 0;
};

}  // namespace drivers_of_test
