// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Topic DSMs whose publishers are gone: subscriptions keep those that hold their newest `depth`
// untaken messages of such publishers, and count the rest as lost.
#include <doctest/doctest.h>

#include <optional>

#include "drivers_of_test.hpp"
#include "node_role.hpp"
#include "transport/matching/closing.hpp"
#include "transport/registry/odd_phase.hpp"
#include "waiting.hpp"

using namespace drivers_of_test;

TEST_CASE(
  "a driver that restarts beside a subscription that takes nothing: no publish is refused") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  f.drive(20, 100'000);
  const uint64_t used = f.inspection.used_bytes();
  for (int i = 0; i < 200; ++i) {
    f.drive(20, 100'000);
    f.inspection.wait_until_swept(1);
  }
  CHECK(f.inspection.used_bytes() == used);
  CHECK(take_all(*stuck) == numbers(f.published - 9, f.published));
  CHECK(stuck->lost() == f.published - 10);
  f.inspection.wait_until_swept();
}

TEST_CASE("a driver that is killed again and again leaves the newest messages, and nothing else") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  for (int i = 0; i < 20; ++i) {
    Node driver(f.platform, 1);
    driver.tell("publisher /driver 10");
    driver.tell(
      "publish " + std::to_string(15 * i + 1) + " " + std::to_string(15 * i + 15) + " 100");
    driver.kill();
    wait_until("the dead driver is reaped", [&] { return f.inspection.live_processes() == 1; });
  }
  f.inspection.wait_until_swept(1);
  CHECK(take_all(*stuck) == numbers(291, 300));
  CHECK(stuck->lost() == 290);
}

TEST_CASE("the newest messages may be of many publishers") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  for (int i = 0; i < 50; ++i) {
    f.drive(1);
  }
  f.inspection.wait_until_swept(10);
  CHECK(take_all(*stuck) == numbers(41, 50));
  CHECK(stuck->lost() == 40);
  f.inspection.wait_until_swept();
}

TEST_CASE("a subscription closed while its publisher writes is freed after that") {
  Fixture f;
  const auto publisher = f.publisher();
  for (int i = 0; i < 3; ++i) {  // the reaper may not have finished its first check in the first
    auto subscription = f.subscription(keep_last(10));
    auto draft = std::make_optional(publisher->draft(sizeof(Payload)));
    subscription.reset();
    CHECK(f.inspection.closing_endpoints() == 1);
    draft.reset();
    f.inspection.wait_until_swept();
  }
}

TEST_CASE("a topic DSM taken whole is freed at once, although a receive thread is in its phase") {
  Fixture f;
  f.platform.receive_thread(1);  // it resets its phase when it starts
  const auto subscription = f.subscription(keep_last(10));
  f.drive(1);
  // Inside a cluster, the receive thread forwards nothing: its phase stays as it is.
  const OddPhase phase(f.inspection.registry().clusters().at(1).header().phase);
  CHECK(take_all(*subscription) == numbers(1, 1));
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("newer messages of a live publisher displace them at the next take") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  f.drive(10);
  const auto publisher = f.publisher();
  for (int i = 0; i < 10; ++i) {
    publish(*publisher, ++f.published);
  }
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK(take_all(*stuck) == numbers(11, 20));
  CHECK(stuck->lost() == 10);
  f.inspection.wait_until_swept();
}

TEST_CASE("each subscription keeps what its own history holds") {
  Fixture f;
  const auto shallow = f.subscription(keep_last(2));
  const auto deep = f.subscription(keep_last(25));
  const auto all = f.subscription(keep_all());
  const auto quick = f.subscription(keep_last(1));
  for (int i = 0; i < 6; ++i) {
    f.drive(10);
    CHECK(take_all(*quick) == numbers(f.published, f.published));
  }
  f.inspection.wait_until_swept(6);
  CHECK(take_all(*all) == numbers(1, 60));
  f.inspection.wait_until_swept(3);
  CHECK(take_all(*deep) == numbers(36, 60));
  CHECK(take_all(*shallow) == numbers(59, 60));
  CHECK(all->lost() == 0);
  CHECK(deep->lost() == 35);
  CHECK(shallow->lost() == 58);
  CHECK(quick->lost() == 0);
  CHECK(quick->superseded() == 54);
}

TEST_CASE("a message that is being read when newer ones push it out stays whole until released") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(2));
  f.drive(2, 5000);
  {
    const std::optional<Claim> claim = stuck->claim();
    REQUIRE(claim);
    for (int i = 0; i < 50; ++i) {
      f.drive(2, 5000);
    }
    f.inspection.wait_until_swept(2);
    CHECK(Payload::read(claim->data(), claim->size()).number == 1);
  }
  CHECK(take_all(*stuck) == numbers(101, 102));
  CHECK(stuck->lost() == 99);
  f.inspection.wait_until_swept();
}

TEST_CASE("backlogged messages that are displaced later are counted once") {
  Fixture f;
  const auto slow = f.subscription(keep_last(4));
  f.drive(4);
  CHECK(take(*slow)->number == 1);  // the others are in its backlog
  f.drive(2);
  CHECK(take(*slow)->number == 3);
  f.drive(4);
  CHECK(take_all(*slow) == numbers(7, 10));
  CHECK(slow->lost() == 4);
}

TEST_CASE("what a resync drops of a gone publisher is freed at once") {
  Fixture f;
  const auto subscription = f.subscription(keep_last(1));
  const auto gone = f.publisher();
  const auto newer = f.publisher();
  {
    const Standstill no_sweeper(f.platform, 1);
    publish(*gone, 1);
    publish(*newer, 2);
    const Registry::Lock lock(f.inspection.registry());
    std::vector<uint32_t> unread;
    closing::close(
      f.inspection.registry(), static_cast<uint32_t>(endpoint_in(gone->gid())), false, unread);
  }
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK(take_all(*subscription) == numbers(2, 2));
  wait_until("its topic DSM is freed", [&] { return f.inspection.closing_endpoints() == 0; });
}
