// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "fast_dds.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "rmw/error_handling.h"

FastDds::FastDds() {
  void * const library = dlopen("librmw_fastrtps_cpp.so", RTLD_LAZY | RTLD_LOCAL);
  void * const function = library != nullptr ? dlsym(library, "rmw_deserialize") : nullptr;
  if (function == nullptr) {
    throw std::runtime_error(dlerror());
  }
  deserialize_ = reinterpret_cast<decltype(deserialize_)>(function);
}

bool FastDds::accepts(
  const rmw_serialized_message_t & cdr, const rosidl_message_type_support_t & type,
  void * message) const {
  try {
    const rmw_ret_t code = deserialize_(&cdr, &type, message);
    rmw_reset_error();
    return code == RMW_RET_OK;
  } catch (const std::length_error &) {
    return false;  // a bounded sequence exceeds its bound: ends a C++ node
  }
}
