// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A program over the rmw interface alone, without rcl's check of RMW_IMPLEMENTATION: prints its
// arguments, the name of its middleware, and the loaded libraries.

#include <fstream>
#include <iostream>

#include "rmw/rmw.h"

int main(int argc, char ** argv) {
  for (int index = 0; index < argc; ++index) {
    std::cout << argv[index] << (index + 1 < argc ? ' ' : '\n');
  }
  std::cout << rmw_get_implementation_identifier() << '\n'
            << std::ifstream("/proc/self/comm").rdbuf() << std::ifstream("/proc/self/maps").rdbuf();
}
