// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/ioctl.h>

#include <string>

#include "messages.hpp"
#include "node_role.hpp"
#include "stepped_child.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/transfer/landing.hpp"
#include "waiting.hpp"

namespace transfer_of_test {

using namespace manycore;

constexpr uint32_t dsm_bytes = 4 << 20;
constexpr Transfer kinds[] = {Transfer::message, Transfer::session, Transfer::async};

/// Publishes message 1, and message 2 of this size, through which the test may step.
inline const Role sends("sends", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(10)));
  wait_until("a match", [&] { return publisher->matched().current == 1; });
  publish(*publisher, 1, sizeof(Payload), 2);
  begin_steps();
  publish(*publisher, 2, std::stoull(arguments.at(1)), 2);
  finish_steps();
});

inline TransferSettings by(Transfer kind, uint8_t priority = 0, bool synchronous = false) {
  TransferSettings settings;
  settings.kind = kind;
  settings.priority = priority;
  settings.synchronous = synchronous ? 1 : 0;
  return settings;
}

inline FileDescriptor open_pipe(const std::string & path) {
  return FileDescriptor(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
}

inline size_t bytes_in(const std::string & path) {
  int bytes = 0;
  const FileDescriptor pipe = open_pipe(path);
  REQUIRE(ioctl(pipe.get(), FIONREAD, &bytes) == 0);
  return static_cast<size_t>(bytes);
}
inline size_t packets_in(const std::string & path) { return bytes_in(path) / sizeof(Packet); }

/// A publisher here, in cluster 1, and a subscriber in cluster 2.
struct Fixture {
  explicit Fixture(
    const TransferSettings & settings, const std::string & subscriber_qos = "1000",
    uint32_t size_bytes = dsm_bytes, const Qos & qos = keep_last(1000))
  : configurator(platform.name(), host_profile(), {{"/x", 1, size_bytes, 0, settings}}) {
    process = platform.join(1);
    subscriber.emplace(platform, 2);
    platform.receive_thread(2);
    used_before = inspection().used_bytes(2);
    subscriber->tell("subscription /x " + subscriber_qos);
    publisher = process->create_publisher(on_topic("/x", qos));
    wait_until("a match", [&] { return publisher->matched().current == 1; });
  }
  ~Fixture() {
    publisher.reset();
    process.reset();
  }

  Inspection & inspection() {
    if (!inspection_) {
      inspection_.emplace(platform);
    }
    return *inspection_;
  }
  Landing landing() {
    Registry & registry = inspection().registry();
    EndpointEntry & entry = registry.endpoints()[inspection().slot_of(publisher->gid())];
    Cluster & own = registry.clusters().at(1);
    return Landing::of(
      own, *own.find<TopicDsmHeader>(entry.block.offset()), registry.clusters().at(2));
  }
  CounterValues counters(EndpointKind kind) {
    for (const EndpointInfo & info : process->graph().endpoints_of("/x")) {
      if (info.kind == kind) {
        return process->graph().activity_of({info}, HeldMemory::skipped).at(0).counters;
      }
    }
    return {};
  }
  uint64_t dropped() { return counters(EndpointKind::publisher).dropped; }
  uint64_t lost() { return counters(EndpointKind::subscription).lost; }
  void publish_numbers(uint64_t first, uint64_t last, size_t size_bytes = sizeof(Payload)) {
    for (uint64_t number = first; number <= last; ++number) {
      publish(*publisher, number, size_bytes);
    }
  }
  void expect(uint64_t first, uint64_t last) {
    subscriber->tell("take " + std::to_string(first) + " " + std::to_string(last) + " 1");
  }

  TestPlatform platform;
  Configurator configurator;
  std::shared_ptr<Process> process;
  std::unique_ptr<Publisher> publisher;
  std::optional<Node> subscriber;
  uint64_t used_before = 0;  ///< in cluster 2, without the subscription

private:
  std::optional<Inspection> inspection_;
};

}  // namespace transfer_of_test
