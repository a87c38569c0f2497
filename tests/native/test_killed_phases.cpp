// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A process is killed at named points of what it does without the registry lock: of a publisher's
// phase and its hand-over to a transfer, of a mover's phase, and of a receive thread's. A point is
// a state of shared memory or of a pipe; the process is single-stepped until it is reached.
#include <doctest/doctest.h>

#include <unistd.h>

#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include "transfer_of_test.hpp"
#include "transport/movers/copy_mover.hpp"
#include "transport/movers/packet_mover.hpp"
#include "transport/notification/receive_thread.hpp"

using namespace manycore;
using transfer_of_test::by;
using transfer_of_test::Fixture;
using transfer_of_test::kinds;

namespace {

constexpr size_t three_packets = 10'000;

/// Act like threads of a receive thread's process; the test stops that one.
const Role moves_packets("moves_packets", [](Lines &, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  PacketMover mover(registry, 2);
  begin_steps();
  mover.run();
});

const Role copies("copies", [](Lines &, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  CopyMover mover(registry, 1);
  begin_steps();
  mover.run();
});

const Role forwards("forwards", [](Lines &, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  ReceiveThread receive_thread(registry, 2);
  begin_steps();
  receive_thread.run([](EmcosMessageKind, uint32_t) {});
});

/// What becomes of the message in hand.
enum class Outcome { nothing, lost, arrives, lost_or_arrives };

struct Point {
  std::string name;
  std::function<bool()> is_reached;
  Outcome outcome;
};

void step_to(SteppedChild & child, const Point & point) {
  while (!point.is_reached()) {
    if (child.step(1) == 0) {
      FAIL("the process did not come to this point");
    }
  }
}

void check(const Point & point, uint64_t taken, uint64_t lost) {
  const bool may_arrive =
    point.outcome == Outcome::arrives || point.outcome == Outcome::lost_or_arrives;
  const bool may_be_lost =
    point.outcome == Outcome::lost || point.outcome == Outcome::lost_or_arrives;
  CHECK(taken + lost == (point.outcome == Outcome::nothing ? 0 : 1));
  CHECK(taken <= (may_arrive ? 1 : 0));
  CHECK(lost <= (may_be_lost ? 1 : 0));
}

/// The endpoint of /x of a kind; there is one.
EndpointEntry & entry_of(Fixture & f, EndpointKind kind) {
  EndpointEntry * found = nullptr;
  for (const EndpointInfo & info : f.process->graph().endpoints_of("/x")) {
    if (info.kind == kind) {
      found = &f.inspection().registry().endpoints()[f.inspection().slot_of(info.gid)];
    }
  }
  REQUIRE(found != nullptr);
  return *found;
}

bool is_odd(const std::atomic<uint64_t> & phase) { return phase.load() % 2 != 0; }

/// A publisher that is stepped through its second message, while no mover goes on.
struct SteppedPublisher {
  explicit SteppedPublisher(Fixture & f, Transfer kind_) : kind(kind_), paths(f.platform.paths()) {
    f.subscriber->tell("take 1 1 2");
    if (kind != Transfer::async) {
      mover = f.platform.stop_receive_thread(kind == Transfer::message ? 2 : 1);
    }
    Clusters & clusters = f.inspection().registry().clusters();
    dsm = clusters.find<TopicDsmHeader>(entry_of(f, EndpointKind::publisher).block);
    landing = &Landing::of(clusters.at(1), *dsm, clusters.at(2)).header();
  }
  ~SteppedPublisher() {
    if (mover != 0) {
      kill(mover, SIGCONT);
    }
  }
  bool has_carried() const {
    switch (kind) {
      case Transfer::message:
        return transfer_of_test::bytes_in(paths.data_pipe(2, 0)) == 3 * sizeof(Packet);
      case Transfer::session:
        return transfer_of_test::bytes_in(paths.session_pipe(1)) == sizeof(CopyRequest);
      default:
        return landing->arrived.load() == 2;
    }
  }
  std::vector<Point> points() const {
    // What is in a pipe and not noted may be given up before the mover comes to it.
    const Outcome carried = kind == Transfer::async ? Outcome::arrives : Outcome::lost_or_arrives;
    return {
      {"in its phase", [this] { return is_odd(dsm->phase); }, Outcome::nothing},
      {"published", [this] { return dsm->last.load() == 2; }, Outcome::lost},
      {"carried", [this] { return has_carried(); }, carried},
      {"handed over", [this] { return landing->handed.load() == 2; }, Outcome::arrives},
      {"decided", [this] { return landing->decided.load() == 2; }, Outcome::arrives},
    };
  }

  Transfer kind;
  PlatformPaths paths;
  pid_t mover = 0;
  TopicDsmHeader * dsm;
  LandingHeader * landing;
};

void kill_publisher(Transfer kind, size_t index) {
  Fixture f(by(kind));
  f.publisher.reset();
  SteppedChild child("sends", {f.platform.name(), std::to_string(three_packets)});
  std::optional<SteppedPublisher> publisher(std::in_place, f, kind);
  const Point point = publisher->points().at(index);
  CAPTURE(point.name);
  const uint64_t taken = f.counters(EndpointKind::subscription).messages;
  step_to(child, point);
  CHECK(is_odd(publisher->dsm->phase));
  child.kill();
  publisher.reset();
  wait_until("the dead publisher's memory is free", [&] {
    f.subscriber->tell("take_all");
    return f.inspection().live_processes() == 2 && f.inspection().closing_endpoints() == 0;
  });
  check(point, f.counters(EndpointKind::subscription).messages - taken, f.lost());
  f.publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  wait_until("a match", [&] { return f.publisher->matched().current == 1; });
  f.publish_numbers(1, 3);
  f.expect(1, 3);
}

/// Has a stand-in for a thread of a receive thread's process handle the second message, kills both
/// at the point, and has the successor go on.
void kill_at_point_of_service(
  Fixture & f, const std::string & role, uint32_t cluster, const Point & point) {
  CAPTURE(point.name);
  // Otherwise the receive thread may be stopped in the phase of the previous message.
  wait_until("the message before is dealt with", [&] { return !point.is_reached(); });
  const pid_t pid = f.platform.stop_receive_thread(cluster);
  f.publish_numbers(2, 2, three_packets);
  const uint64_t taken = f.counters(EndpointKind::subscription).messages;
  SteppedChild child(role, {f.platform.name()});
  step_to(child, point);
  child.kill();
  kill(pid, SIGKILL);
  f.platform.receive_thread(cluster, pid);
  wait_until("the message is taken, or counted as lost", [&] {
    f.subscriber->tell("take_all");
    return f.counters(EndpointKind::subscription).messages - taken + f.lost() != 0;
  });
  check(point, f.counters(EndpointKind::subscription).messages - taken, f.lost());
  f.publish_numbers(3, 5);
  f.expect(3, 5);
}

void kill_mover(Transfer kind, size_t index) {
  Fixture f(by(kind));
  f.publish_numbers(1, 1);
  f.expect(1, 1);
  const bool is_message = kind == Transfer::message;
  const uint32_t cluster = is_message ? 2 : 1;
  Registry & registry = f.inspection().registry();
  const std::atomic<uint64_t> & phase =
    registry.clusters().at(cluster).header().mover_phases[is_message ? 0 : 1];
  const Landing landing = f.landing();
  const std::vector<Point> points = {
    {"in its phase", [&] { return is_odd(phase); }, Outcome::lost},
    {"marked", [&] { return landing.has(2); }, Outcome::arrives},
    {"arrived", [&] { return landing.arrived() == 2; }, Outcome::arrives},
    {"done", [&] { return landing.header().done.load() == 2; }, Outcome::arrives},
    {"out of its phase", [&] { return landing.header().done.load() == 2 && !is_odd(phase); },
     Outcome::arrives},
  };
  kill_at_point_of_service(f, is_message ? "moves_packets" : "copies", cluster, points.at(index));
}

}  // namespace

TEST_CASE("a publisher killed at a point of its phase and of its hand-over") {
  for (const Transfer kind : kinds) {
    CAPTURE(static_cast<int>(kind));
    for (size_t index = 0; index < 5; ++index) {
      kill_publisher(kind, index);
    }
  }
}

TEST_CASE("a mover killed at a point of its phase") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    CAPTURE(static_cast<int>(kind));
    for (size_t index = 0; index < 5; ++index) {
      kill_mover(kind, index);
    }
  }
}

TEST_CASE("a mover killed between two packets of a message") {
  Fixture f(by(Transfer::message));
  f.publish_numbers(1, 1);
  f.expect(1, 1);
  const LandingHeader & landing = f.landing().header();
  const auto has_some = [&] {
    return landing.partial_number.load() == 2 && landing.partial_bytes.load() != 0;
  };
  kill_at_point_of_service(f, "moves_packets", 2, {"some packets", has_some, Outcome::lost});
}

TEST_CASE("a receive thread killed at a point of its phase: the message arrives once") {
  for (size_t index = 0; index < 3; ++index) {
    Fixture f(by(Transfer::dsm));
    f.publish_numbers(1, 1);
    f.expect(1, 1);
    Clusters & clusters = f.inspection().registry().clusters();
    const ClusterHeader & cluster = clusters.at(2).header();
    const auto * const subscription =
      clusters.find<SubscriptionHeader>(entry_of(f, EndpointKind::subscription).block);
    const uint64_t tail = subscription->tail.load();
    const uint64_t notifications = cluster.notifications.load();
    const std::vector<Point> points = {
      {"in its phase", [&] { return is_odd(cluster.phase); }, Outcome::arrives},
      {"pushed", [&] { return subscription->tail.load() != tail; }, Outcome::arrives},
      {"counted", [&] { return cluster.notifications.load() != notifications; }, Outcome::arrives},
    };
    kill_at_point_of_service(f, "forwards", 2, points.at(index));
  }
}
