// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The files of a platform are removed while its processes run: all notice, and none stays.
#include <doctest/doctest.h>

#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "messages.hpp"
#include "node_role.hpp"
#include "transport/registry/registry.hpp"
#include "waiting.hpp"

using namespace manycore;

TEST_CASE("files removed from outside: members notice, and a new platform begins") {
  TestPlatform platform;
  Node other(platform, 2);
  const auto process = platform.join(1);
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
  const pid_t receive_threads[] = {platform.receive_thread(1), platform.receive_thread(2)};
  SUBCASE("all of them") { remove_used(platform.paths().directory); }
  SUBCASE("one of them") { unlink(platform.paths().pipe(2).c_str()); }
  SUBCASE("moved away") {
    const std::string elsewhere = platform.paths().user_directory + "/elsewhere";
    REQUIRE(rename(platform.paths().directory.c_str(), elsewhere.c_str()) == 0);
    std::filesystem::remove_all(elsewhere);
  }
  SUBCASE("while a receive thread is being killed") {
    kill(receive_threads[0], SIGKILL);
    remove_used(platform.paths().directory);
  }
  for (const pid_t pid : receive_threads) {
    wait_until("the receive threads have ended", [&] { return !is_running(pid); });
  }
  wait_until("the member notices", [&] { return process->is_cut_off(); });
  CHECK(refusal_of([&] { publish(*publisher, 1); }).says("restart this process"));
  CHECK(refusal_of([&] { process->require_membership(); }).code == ErrorCode::system);
  CHECK(platform.receive_threads().empty());
  remove_used(platform.paths().directory);
  Node newcomer(platform, 1);
  CHECK(newcomer.ask("publisher /x 1") == "ok");
  platform.receive_thread(1);  // it reaps the killed newcomer
}

// A repair maps all clusters, and the files of unmapped ones are gone.
TEST_CASE("files removed from outside after the owner of the registry lock was killed") {
  TestPlatform platform;
  const Node other(platform, 2);
  const pid_t witness = platform.receive_thread(2);
  const auto process = platform.join(1);
  const pid_t owner = platform.receive_thread(1);
  {
    const Standstill looks_later(platform, 2);
    platform.stop_receive_thread(1);
    Registry(platform.paths()).header().needs_repair = 1;
    remove_used(platform.paths().directory);
    kill(owner, SIGKILL);
    wait_until("it is dead", [&] { return !is_running(owner); });
  }
  wait_until("the other receive thread has ended", [&] { return !is_running(witness); });
}
