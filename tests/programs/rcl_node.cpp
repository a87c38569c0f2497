// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A C++ node: prints its arguments, the name of its middleware, and the libraries loaded while the
// node exists.

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "rcl/error_handling.h"
#include "rcl/rcl.h"
#include "rmw/rmw.h"

// Referenced by the Python message libraries, to which librcl.so of the wheels is linked; never
// used. The stand-ins of rmw_manycore define them, nothing does so beside Fast DDS.
#ifndef ONLY_FOR_MANYCORE
extern "C" {
void * PyExc_RuntimeError = nullptr;
void * _Py_TrueStruct = nullptr;
}
#endif

namespace {

void expect_ok(rcl_ret_t code) {
  if (code != RCL_RET_OK) {
    std::cerr << rcl_get_error_string().str << '\n';
    std::exit(1);
  }
}

}  // namespace

int main(int argc, char ** argv) {
  rcl_init_options_t options = rcl_get_zero_initialized_init_options();
  rcl_context_t context = rcl_get_zero_initialized_context();
  rcl_node_t node = rcl_get_zero_initialized_node();
  const rcl_node_options_t node_options = rcl_node_get_default_options();
  expect_ok(rcl_init_options_init(&options, rcl_get_default_allocator()));
  expect_ok(rcl_init(argc, argv, &options, &context));
  expect_ok(rcl_node_init(&node, "node", "", &context, &node_options));
  for (int index = 0; index < argc; ++index) {
    std::cout << argv[index] << (index + 1 < argc ? ' ' : '\n');
  }
  std::cout << rmw_get_implementation_identifier() << '\n'
            << std::ifstream("/proc/self/comm").rdbuf() << std::ifstream("/proc/self/maps").rdbuf();
  expect_ok(rcl_node_fini(&node));
  expect_ok(rcl_shutdown(&context));
  expect_ok(rcl_context_fini(&context));
  expect_ok(rcl_init_options_fini(&options));
}
