// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Names of platforms, and places from the environment.
#include <doctest/doctest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"

using namespace manycore;

TEST_CASE("invalid platform names never become paths") {
  for (const std::string & name :
       {std::string(""), std::string("."), std::string(".."), std::string("a/b"),
        std::string(".hidden"), std::string("-x"), std::string("a b"), std::string(65, 'x'),
        std::string("a\0b", 3), std::string("b\xc3\xbc"), std::string("\xff")}) {
    CAPTURE(name);
    const Refusal refusal = refusal_of([&] { PlatformPaths::of(name); });
    CHECK(refusal.code == ErrorCode::invalid_argument);
    CHECK(refusal.says("not a valid platform name"));
    CHECK_FALSE(PlatformPaths::is_name(name));
    CHECK(std::all_of(
      refusal.text.begin(), refusal.text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
  }
}

TEST_CASE("no platform name collides with a file of the platform or of the user directory") {
  for (const std::string name : {"lock", "alive", "registry", "cluster-1"}) {
    CAPTURE(name);
    const auto process = join_platform(name);
    const std::vector<std::string> names = platform_names();
    CHECK(std::count(names.begin(), names.end(), name) == 1);
    CHECK(is_alive(PlatformPaths::of(name)));
  }
}

TEST_CASE("a directory whose name is not a valid platform name is not listed") {
  const TestPlatform platform;
  const auto process = platform.join();
  const std::string stray = platform.paths().user_directory + "/\xff" + std::to_string(getpid());
  REQUIRE(mkdir(stray.c_str(), 0700) == 0);
  for (const std::string & name : platform_names()) {
    CHECK(PlatformPaths::is_name(name));
  }
  rmdir(stray.c_str());
}

TEST_CASE("environment variables are checked, and named when they are invalid") {
  const std::pair<const char *, const char *> wrong[] = {
    {"MANYCORE_CLUSTER", "0"},  {"MANYCORE_CLUSTER", "65"},  {"MANYCORE_CLUSTER", "two"},
    {"MANYCORE_CLUSTER", "1x"}, {"MANYCORE_CLUSTER", "-1"},  {"MANYCORE_CORE", "1024"},
    {"MANYCORE_CORE", "-1"},    {"MANYCORE_WAIT", "busily"},
  };
  for (const auto & [name, value] : wrong) {
    setenv(name, value, 1);
    const Refusal refusal = refusal_of([] { Placement::from_environment(); });
    unsetenv(name);
    CHECK(refusal.code == ErrorCode::invalid_argument);
    CHECK(refusal.says(std::string(name) + "='" + value + "'"));
  }
  setenv("MANYCORE_CLUSTER", "3", 1);
  setenv("MANYCORE_WAIT", "adaptive", 1);
  const Placement placement = Placement::from_environment(42);
  unsetenv("MANYCORE_CLUSTER");
  unsetenv("MANYCORE_WAIT");
  CHECK(placement.platform == "domain-42");
  CHECK(placement.cluster == 3);
  CHECK_FALSE(placement.core);
  CHECK(placement.wait_mode == WaitMode::adaptive);
}

TEST_CASE("the named platform is that of one domain; others are not placed on it") {
  setenv("ROS_DOMAIN_ID", "7", 1);
  setenv("MANYCORE_CLUSTER", "3", 1);
  setenv("MANYCORE_CORE", "2", 1);
  CHECK(Placement::from_environment().platform == "domain-7");
  CHECK(Placement::from_environment(8).cluster == 3);
  setenv("MANYCORE_PLATFORM", "robot", 1);
  const Placement named = Placement::from_environment();
  const Placement same = Placement::from_environment(7);
  const Placement other = Placement::from_environment(8);
  for (const char * name : {"ROS_DOMAIN_ID", "MANYCORE_CLUSTER", "MANYCORE_CORE"}) {
    unsetenv(name);
  }
  CHECK(Placement::from_environment(0).platform == "robot");
  unsetenv("MANYCORE_PLATFORM");
  CHECK(named.platform == "robot");
  CHECK(same.platform == "robot");
  CHECK(same.cluster == 3);
  CHECK(same.core == 2u);
  CHECK(other.platform == "domain-8");
  CHECK(other.cluster == 1);
  CHECK_FALSE(other.core);
}
