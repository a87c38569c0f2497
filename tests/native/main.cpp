// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Every test program: its doctest cases, or, started with --role, one of the processes that they
// need.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <csignal>

#include "child.hpp"
#include "private_shm.hpp"

int main(int argc, char ** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // talking to the dead is an error of the test, with a message
  int status = 0;
  if (Role::play(argc, argv, status)) {
    return status;
  }
  enter_private_shm();
  return doctest::Context(argc, argv).run();
}
