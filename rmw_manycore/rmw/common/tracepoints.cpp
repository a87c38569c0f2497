// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/tracepoints.hpp"

#include <dlfcn.h>

namespace rmw_manycore {
namespace {

/// Prefers a definition preloaded by LD_PRELOAD, as for linked functions.
template<typename Function>
void find(Function *& function, void * library, const char * name) noexcept {
  void * found = dlsym(RTLD_DEFAULT, name);
  if (found == nullptr && library != nullptr) {
    found = dlsym(library, name);
  }
  function = reinterpret_cast<Function *>(found);
}

Tracepoints find_all() noexcept {
  // Python loads extension modules and their dependencies with local scope, so RTLD_DEFAULT misses
  // them.
  void * const library = dlopen("libtracetools.so", RTLD_LAZY | RTLD_NOLOAD);
  Tracepoints found{};
  find(found.publisher_init, library, "ros_trace_rmw_publisher_init");
  find(found.publish, library, "ros_trace_rmw_publish");
  find(found.subscription_init, library, "ros_trace_rmw_subscription_init");
  find(found.take, library, "ros_trace_rmw_take");
  find(found.client_init, library, "ros_trace_rmw_client_init");
  find(found.send_request, library, "ros_trace_rmw_send_request");
  find(found.take_request, library, "ros_trace_rmw_take_request");
  find(found.send_response, library, "ros_trace_rmw_send_response");
  find(found.take_response, library, "ros_trace_rmw_take_response");
  return found;
}

}  // namespace

const Tracepoints & tracepoints() noexcept {
  static const Tracepoints found = find_all();
  return found;
}

}  // namespace rmw_manycore
