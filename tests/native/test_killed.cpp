// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A process is killed at any instruction of joining, leaving, creating and closing endpoints,
// publishing, taking, and reaping.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "killed_of_test.hpp"
#include "transport/lifecycle/cleaning.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/lifecycle/trace_control.hpp"

using namespace manycore;
using killed_of_test::check_kills;
using killed_of_test::Fixture;

namespace {

size_t files_in(const std::string & directory) {
  std::error_code gone;  // with the last file
  const std::filesystem::directory_iterator all(directory, gone);
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}

/// Steps a process in `role` until it has made this many changes to matches with the fixture's
/// endpoints, and kills it. False if it makes fewer.
bool kill_after_change(Fixture & f, const std::string & role, size_t changes) {
  SteppedChild child(role, {f.platform.name()});
  for (uint64_t before = f.matches(); changes != 0;) {
    if (child.step(1) == 0) {
      return false;
    }
    const uint64_t now = f.matches();
    changes -= now == before ? 0 : 1;
    before = now;
  }
  child.kill();
  return true;
}

/// Kills it after these changes; unless MANYCORE_TEST_STEPS is set, only where it has begun to make
/// a match, and counted one end of one that it undoes.
void check_kills_after_changes(Fixture & f, const std::string & role, size_t all_changes) {
  f.platform.receive_thread(1);
  f.check_that_it_goes_on();
  const bool has_landing = f.has_landing();
  for (size_t changes = 1; changes <= all_changes; ++changes) {
    if (!killed_of_test::asked_tries() && changes % 7 > 2) {
      continue;
    }
    CAPTURE(changes);
    if (!kill_after_change(f, role, changes)) {
      CHECK(changes > 1);
      return;
    }
    f.wait_until_alone();
    f.check_that_it_goes_on();
    CHECK(f.has_landing() == has_landing);
    CHECK(f.has_landing() == f.resident.has_value());
  }
}

}  // namespace

TEST_CASE("killed at any instruction while it joins") { check_kills("joins"); }

TEST_CASE("killed at any instruction while it creates and closes endpoints") {
  check_kills("creates");
}

TEST_CASE(
  "killed at any instruction while it backs a large topic DSM and queue, and gives them back") {
  check_kills("sizes");
}

TEST_CASE("killed at any instruction while it makes landings, and gives them back") {
  check_kills("moves");
}

TEST_CASE("killed in a match that it makes or undoes: both ends agree again") {
  Fixture f;
  check_kills_after_changes(f, "matches", 16);
}

TEST_CASE("killed in a match whose messages are transferred: others keep their landing") {
  Fixture f;
  f.move_topic();
  f.subscribe_resident();
  check_kills_after_changes(f, "moves", 12);
}

TEST_CASE("killed in a match that it undoes, and then another process in another match") {
  Fixture f;
  f.platform.receive_thread(1);
  SteppedChild child("closes", {f.platform.name()});
  const Standstill no_reaper(f.platform, 1);
  while (f.inspection.closing_endpoints() == 0) {
    REQUIRE(child.step(1) == 1);
  }
  child.kill();
  const auto late = f.process->create_subscription(on_topic(killed_roles::topic, keep_last(1)));
  Registry & registry = f.inspection.registry();
  registry.header().needs_repair = 1;  // as if its process had been killed with the lock
  { const Registry::Lock repairs(registry); }
  CHECK(f.publisher->matched().current == 3);
}

TEST_CASE("killed at any instruction while it publishes") { check_kills("publishes"); }

TEST_CASE("killed at any instruction while it takes messages") { check_kills("takes"); }

TEST_CASE("killed at any instruction while it reaps other dead processes") { check_kills("reaps"); }

// The kernel ends the threads of a killed process one by one. The registry lock is not taken over
// while the thread that holds the lifeline lives.
TEST_CASE("killed thread by thread while it closes: nothing is freed that publishers still use") {
  Fixture f;
  f.platform.receive_thread(1);
  f.check_that_it_goes_on();
  const uint64_t used = f.inspection.used_bytes();
  SteppedChild child("closes", {f.platform.name()});
  while (f.inspection.closing_endpoints() == 0) {
    REQUIRE(child.step(1) == 1);
  }
  child.end_main_thread();
  const Refusal refusal = refusal_of(
    [&] { const Registry::Lock lock(f.inspection.registry(), Registry::Lock::short_wait_ns); });
  CHECK(refusal.code == ErrorCode::timeout);
  child.kill();
  f.wait_until_alone();
  CHECK(f.inspection.readers_of(*f.publisher).size() == 2);
  f.check_that_it_goes_on();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("killed after it recorded a death: no other reaper records that death again") {
  Fixture f;
  f.platform.receive_thread(1);
  const std::atomic<uint64_t> & deaths = f.inspection.registry().header().death_count;
  {
    const Standstill no_other_reaper(f.platform, 1);
    f.leave_dead_nodes();
    SteppedChild reaper("reaps", {f.platform.name()});
    while (deaths.load() == 0) {
      REQUIRE(reaper.step(1) == 1);
    }
    REQUIRE(f.inspection.live_processes() == 2);
    reaper.kill();
  }
  f.wait_until_alone();
  CHECK(deaths.load() == 1);
}

TEST_CASE("killed while it creates a platform: the next process creates it, and 'clean' works") {
  const TestPlatform platform;
  const std::string directory = platform.paths().directory;
  const auto kill_at = [&](size_t files, uint64_t more) {
    SteppedChild first("joins", {platform.name()});
    while (!std::filesystem::exists(directory) || files_in(directory) < files) {
      first.run_to_system_call();
      REQUIRE_FALSE(first.finished());
    }
    first.step(more);
    first.kill();
  };
  for (const size_t files : {1, 2}) {
    for (const uint64_t more : {0, 200, 2000}) {
      CAPTURE(files);
      CAPTURE(more);
      kill_at(files, more);
      CHECK_NOTHROW(clean_platform(platform.name()));
      CHECK_FALSE(platform.exists());
      kill_at(files, more);
      CHECK_NOTHROW(platform.join(1));
    }
  }
}

TEST_CASE("killed while it creates its trace file: the file is removed") {
  Fixture f;
  f.platform.receive_thread(1);
  start_trace(f.inspection.registry(), {});
  SteppedChild traced("joins", {f.platform.name()});
  const std::string part_of_name = "." + std::to_string(traced.pid()) + ".";
  const auto is_unfinished = [&] {
    const std::filesystem::directory_iterator all(f.platform.paths().directory);
    return std::any_of(begin(all), end(all), [&](const auto & file) {
      return file.path().filename().string().find(part_of_name) != std::string::npos;
    });
  };
  while (!is_unfinished()) {
    traced.run_to_system_call();
    REQUIRE_FALSE(traced.finished());
  }
  traced.kill();
  wait_until("the file is gone", [&] { return !is_unfinished(); });
}

TEST_CASE("killed while it removes a platform: the receive threads finish the removal") {
  const TestPlatform platform;
  SteppedChild last("leaves", {platform.name()});
  platform.receive_thread(1);
  const std::string directory = platform.paths().directory;
  const size_t all = files_in(directory);
  while (files_in(directory) == all) {
    last.run_to_system_call();
    REQUIRE_FALSE(last.finished());
  }
  last.kill();
  wait_until("the platform is gone", [&] { return !platform.exists(); });
}
