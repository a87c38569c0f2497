// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Main program of each test: runs the doctest cases or, with --role, one of the processes they use.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <csignal>

#include "child.hpp"
#include "private_shm.hpp"

int main(int argc, char ** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // writing to a dead process becomes an error with a message
  int status = 0;
  if (Role::play(argc, argv, status)) {
    return status;
  }
  enter_private_shm();
  return doctest::Context(argc, argv).run();
}
