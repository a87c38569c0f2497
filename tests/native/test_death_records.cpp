// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What the registry records of processes that died, and what of theirs is used again.
#include <doctest/doctest.h>

#include <unistd.h>

#include "node_role.hpp"
#include "platform/clock.hpp"
#include "survivor.hpp"
#include "transport/registry/smem_charge.hpp"

using namespace manycore;

TEST_CASE("a killed process is recorded as dead, one that leaves is not") {
  Survivor f;
  f.platform.join(1).reset();
  f.wait_until_alone();
  CHECK(f.process->graph().deaths().empty());
  pid_t killed = 0;
  {
    Node node(f.platform, 1);
    killed = node.pid();
    node.kill();
  }
  f.wait_until_alone();
  const std::vector<Death> deaths = f.process->graph().deaths();
  REQUIRE(deaths.size() == 1);
  CHECK(deaths[0].pid == killed);
  CHECK(deaths[0].found_ns <= monotonic_ns());
}

TEST_CASE("a process that is killed once all its contexts are shut down does not count as dead") {
  Survivor f;
  const auto killed_after = [&](const std::vector<const char *> & steps) {
    const size_t before = f.process->graph().deaths().size();
    {
      Node node(f.platform, 1);
      for (const char * const step : steps) {
        node.tell(step);
      }
      node.kill();
    }
    f.wait_until_alone();
    return f.process->graph().deaths().size() != before;
  };
  CHECK(killed_after({"begin_context"}));
  CHECK_FALSE(killed_after({"begin_context", "end_context"}));
  CHECK(killed_after({"begin_context", "begin_context", "end_context"}));
  CHECK_FALSE(killed_after({"begin_context", "end_context", "begin_context", "end_context"}));
  CHECK(killed_after({"begin_context", "end_context", "begin_context"}));
}

TEST_CASE("a death that no reaper has recorded is recorded as the platform is removed") {
  const TestPlatform platform;
  auto process = platform.join(1);
  Inspection inspection(platform);
  const Standstill reaper(platform, 1);
  Node node(platform, 1);
  const pid_t killed = node.pid();
  node.kill();
  process.reset();
  REQUIRE_FALSE(platform.exists());
  const std::vector<Death> deaths = Graph(inspection.registry()).deaths();
  REQUIRE(deaths.size() == 1);
  CHECK(deaths[0].pid == killed);
}

TEST_CASE("memory that a killed process had charged is given back") {
  Survivor f;
  const ClusterHeader & cluster = f.inspection.registry().clusters().at(1).header();
  charge_smem(f.inspection.registry(), ProcessIdentity::own(), 300);
  {
    Node node(f.platform, 1);
    charge_smem(f.inspection.registry(), ProcessIdentity::of(node.pid()), 4000);
    CHECK(cluster.charged_bytes.load() == 4300);
  }
  f.wait_until_alone();
  CHECK(cluster.charged_bytes.load() == 300);
}

TEST_CASE("slots of the dead are used again") {
  Survivor f;
  for (int i = 0; i < 10; ++i) {
    Node node(f.platform, 1);
    node.tell("publisher /x 1");
    node.kill();
    f.wait_until_alone();
  }
  CHECK(f.inspection.registry().processes().high_water() == 2);
  CHECK(f.inspection.registry().endpoints().high_water() == 1);
}
