// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A cluster whose SMEM or file system is full of messages still accepts nodes.
#include <doctest/doctest.h>

#include <sys/mount.h>

#include "messages.hpp"
#include "node_role.hpp"
#include "private_shm.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint64_t mebibyte = 1 << 20;

Profile profile_of(uint64_t smem_bytes) {
  Profile profile = host_profile();
  profile.smem_bytes = smem_bytes;
  return profile;
}

/// A cluster that a process has filled with messages.
class FullCluster {
public:
  FullCluster(uint64_t smem_bytes, const std::vector<TopicConfiguration> & topics)
  : configurator_(platform.name(), profile_of(smem_bytes), topics), process(platform.join()) {}

  /// Publishes on growing topics whose histories keep all messages, until no message fits.
  Refusal fill() {
    Refusal refusal;
    for (size_t size_bytes = mebibyte / 2; size_bytes >= 4096; size_bytes /= 2) {
      do {
        const std::string topic = "/full_" + std::to_string(publishers_.size());
        publishers_.push_back(process->create_publisher(on_topic(topic, transient_local(1))));
        refusal = refusal_of([&] { publish(*publishers_.back(), 1, size_bytes); });
      } while (refusal.code != ErrorCode::too_large);  // the lock may be held by another process
    }
    return refusal;
  }

  TestPlatform platform;

private:
  Configurator configurator_;

public:
  std::shared_ptr<Process> process;

private:
  std::vector<std::unique_ptr<Publisher>> publishers_;
};

/// Creates as many endpoints as five rclpy nodes have, in a process that joins late.
const Role latecomer("latecomer", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (int i = 0; i < 50; ++i) {
    process->add_node("late_" + std::to_string(i), "/", "/");
    const std::string topic = "/late_" + std::to_string(i);
    publishers.push_back(process->create_publisher(on_topic(topic, keep_last(10))));
    subscriptions.push_back(process->create_subscription(on_topic(topic, keep_last(10))));
  }
  for (uint64_t number = 1; number <= 50; ++number) {
    for (size_t i = 0; i < publishers.size(); ++i) {
      publish(*publishers[i], number, 200);
      require(take(*subscriptions[i])->number == number);
    }
  }
  const Refusal refusal = refusal_of([&] { publish(*publishers[0], 51, 100'000); });
  publish(*publishers[0], 51, 200);
  require(take(*subscriptions[0])->number == 51);
  test.say(refusal.text);
});

void check_latecomer(const TestPlatform & platform) {
  Child late("latecomer", {platform.name()});
  const std::string refusal = late.hear();
  const bool explains = refusal.find("has no room for") != std::string::npos &&
                        refusal.find("are reserved for further nodes") != std::string::npos;
  CHECK_MESSAGE(explains, refusal);
  CHECK(late.wait() == 0);
}

}  // namespace

TEST_CASE("a cluster full of topic DSMs accepts nodes, publishers, subscriptions, small messages") {
  FullCluster full(4 * mebibyte, {});
  const Refusal refusal = full.fill();
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK_MESSAGE(refusal.says("are reserved for further nodes"), refusal.text);
  check_latecomer(full.platform);
}

TEST_CASE("a cluster full of fixed topic DSMs accepts nodes as well") {
  FullCluster full(4 * mebibyte, {{"/fixed", 1, 700'000, 0}});
  std::vector<std::unique_ptr<Publisher>> publishers;
  const Refusal refusal = refusal_of([&] {
    while (true) {
      publishers.push_back(full.process->create_publisher(on_topic("/fixed", keep_last(1))));
    }
  });
  CHECK(refusal.code == ErrorCode::no_space);
  CHECK_MESSAGE(refusal.says("are reserved for further nodes"), refusal.text);
  full.fill();
  check_latecomer(full.platform);
}

TEST_CASE("a cluster on a full file system accepts nodes as well") {
  if (!has_private_shm()) {
    return;  // never fills the machine's /dev/shm
  }
  wait_until_private_shm_is_free();
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=16m") == 0);
  {
    FullCluster full(64 * mebibyte, {});
    const Refusal refusal = full.fill();
    CHECK(refusal.code == ErrorCode::too_large);
    CHECK_MESSAGE(refusal.says("'s file system are free"), refusal.text);
    check_latecomer(full.platform);
  }
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=50%") == 0);
}
