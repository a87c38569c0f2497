// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The private list of an endpoint's peers, which it renews by walks along a topic's chain.
#include <doctest/doctest.h>

#include <atomic>
#include <random>
#include <thread>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform_of_test.hpp"
#include "transport/peers/peers.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr const char * topic = "/peers";

struct Fixture {
  std::unique_ptr<Publisher> publisher(const Qos & qos = keep_last(1)) {
    return process->create_publisher(on_topic(topic, qos));
  }
  std::unique_ptr<Subscription> subscription(
    const Qos & qos = keep_last(1), const char * of_topic = topic) {
    return process->create_subscription(on_topic(of_topic, qos));
  }
  Peers peers_of(const Gid & gid) {
    return Peers(registry, registry.endpoints()[inspection.slot_of(gid)]);
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  Registry & registry = inspection.registry();
};

std::vector<Gid> gids_of(const Peers & peers) {
  std::vector<Gid> gids;
  for (const Peer & peer : peers.all()) {
    gids.push_back(peer.gid);
  }
  return gids;
}

}  // namespace

TEST_CASE("peers are those that are there, the youngest last") {
  Fixture f;
  const auto own = f.publisher();
  Peers peers = f.peers_of(own->gid());
  CHECK(peers.refresh());
  CHECK(peers.all().empty());
  auto first = f.subscription();
  const auto second = f.subscription();
  const auto elsewhere = f.subscription(keep_last(1), "/elsewhere");
  const auto colleague = f.publisher();
  CHECK(peers.refresh());
  CHECK(gids_of(peers) == std::vector<Gid>{first->gid(), second->gid()});
  CHECK_FALSE(peers.refresh());
  first.reset();
  const auto third = f.subscription();
  CHECK(peers.refresh());
  CHECK(gids_of(peers) == std::vector<Gid>{second->gid(), third->gid()});
  CHECK(peers.counts().matched_total == 3);
}

TEST_CASE("what does not fit is counted once") {
  Fixture f;
  const auto own = f.publisher(best_effort(1));
  Peers peers = f.peers_of(own->gid());
  const auto reliable = f.subscription(keep_last(1));
  EndpointSpec spec = on_topic(topic, best_effort(1));
  spec.type = "test_msgs/msg/Other";
  const auto other_type = f.process->create_subscription(spec);
  peers.refresh();
  const auto modest = f.subscription(best_effort(1));
  peers.refresh();
  CHECK(gids_of(peers) == std::vector<Gid>{modest->gid()});
  CHECK(peers.counts().incompatible_qos == 1);
  CHECK(peers.counts().last_policy == QosPolicy::reliability);
  CHECK(peers.counts().incompatible_types == 1);
  CHECK(peers.counts().matched_total == 1);
}

TEST_CASE("a peer whose process was killed counts as died, until another one comes") {
  Fixture f;
  const auto own = f.subscription();
  Peers peers = f.peers_of(own->gid());
  Node driver(f.platform, 1);
  driver.tell(std::string("publisher ") + topic + " 1");
  peers.refresh();
  REQUIRE(peers.all().size() == 1);
  driver.kill();
  wait_until("the dead driver is reaped", [&] { return f.inspection.live_processes() == 1; });
  peers.refresh();
  CHECK(peers.all().empty());
  CHECK(peers.counts().died == 1);
  auto successor = f.publisher();
  peers.refresh();
  CHECK(peers.counts().died == 0);
  successor.reset();
  peers.refresh();
  CHECK(peers.all().empty());
  CHECK(peers.counts().died == 0);
}

TEST_CASE("a repair tells each endpoint to look again") {
  Fixture f;
  const auto own = f.publisher();
  const auto peer = f.subscription();
  Peers peers = f.peers_of(own->gid());
  peers.refresh();
  {
    const Registry::Lock lock(f.registry);
    f.registry.header().needs_repair = 1;
  }
  { const Registry::Lock repairs(f.registry); }
  CHECK(peers.refresh());
  CHECK(gids_of(peers) == std::vector<Gid>{peer->gid()});
}

// Endpoints of this and of another topic come and go in the same slots meanwhile. It cannot show
// that a walk is right at each instruction; docs/model/chains.pml does that.
TEST_CASE("peers that stay are in the list, once, whatever comes and goes meanwhile") {
  Fixture f;
  const auto own = f.publisher();
  const auto oldest = f.subscription();
  Peers peers = f.peers_of(own->gid());
  std::atomic<bool> is_over{false};
  std::thread changer([&] {
    std::minstd_rand random(1);
    std::vector<std::unique_ptr<Subscription>> guests(8);
    for (int i = 0; i < 3000; ++i) {
      auto & guest = guests[random() % guests.size()];
      guest.reset();
      if (random() % 4 != 0) {
        guest = f.subscription(keep_last(1), random() % 2 == 0 ? topic : "/elsewhere");
      }
    }
    is_over = true;
  });
  uint64_t missed = 0;
  uint64_t doubled = 0;
  while (!is_over) {
    peers.refresh();
    std::vector<Gid> gids = gids_of(peers);
    missed += std::count(gids.begin(), gids.end(), oldest->gid()) == 1 ? 0 : 1;
    std::sort(gids.begin(), gids.end());
    doubled += std::adjacent_find(gids.begin(), gids.end()) == gids.end() ? 0 : 1;
  }
  changer.join();
  CHECK(missed == 0);
  CHECK(doubled == 0);
  peers.refresh();
  CHECK(gids_of(peers) == std::vector<Gid>{oldest->gid()});
}
