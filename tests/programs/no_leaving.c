// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Replaces rmw_destroy_node by LD_PRELOAD with one that never returns.
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

int32_t rmw_destroy_node(const void * node) {
  fprintf(stderr, "rmw_destroy_node %p\n", node);
  for (;;) {
    pause();
  }
}
