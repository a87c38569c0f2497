// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A process is killed at any instruction of what takes more than one hold of the registry lock. A
// program of its own: together with those of test_killed.cpp it would be the last one to end.
#include <doctest/doctest.h>

#include "killed_of_test.hpp"

using killed_of_test::check_kills;

TEST_CASE("killed at any instruction while it closes endpoints of many matches") {
  check_kills("closes_many");
}

TEST_CASE("killed at any instruction while it sweeps a topic DSM that many readers are done with") {
  check_kills("sweeps_many");
}
