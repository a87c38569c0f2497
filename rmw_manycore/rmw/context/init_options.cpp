// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/init_options.h"

#include "rcpputils/scope_exit.hpp"
#include "rcutils/strdup.h"
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/domain_id.h"

rmw_ret_t rmw_init_options_init(rmw_init_options_t * init_options, rcutils_allocator_t allocator) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(init_options);
  RCUTILS_CHECK_ALLOCATOR(&allocator, return RMW_RET_INVALID_ARGUMENT);
  if (init_options->implementation_identifier != nullptr) {
    RMW_SET_ERROR_MSG("expected zero-initialized init_options");
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  rmw_init_options_t created = rmw_get_zero_initialized_init_options();
  created.implementation_identifier = rmw_manycore::identifier;
  created.allocator = allocator;
  created.domain_id = RMW_DEFAULT_DOMAIN_ID;
  created.security_options = rmw_get_default_security_options();
  created.discovery_options = rmw_get_zero_initialized_discovery_options();
  const rmw_ret_t result = rmw_discovery_options_init(&created.discovery_options, 0, &allocator);
  if (result == RMW_RET_OK) {
    *init_options = created;
  }
  return result;
}

rmw_ret_t rmw_init_options_copy(const rmw_init_options_t * src, rmw_init_options_t * dst) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(src);
  MANYCORE_CHECK_ARGUMENT(dst);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    src->implementation_identifier, "expected initialized src", return RMW_RET_INVALID_ARGUMENT);
  MANYCORE_CHECK_HANDLE(src);
  if (dst->implementation_identifier != nullptr) {
    RMW_SET_ERROR_MSG("expected zero-initialized dst");
    return RMW_RET_INVALID_ARGUMENT;
  }
  rcutils_allocator_t allocator = src->allocator;
  RCUTILS_CHECK_ALLOCATOR(&allocator, return RMW_RET_INVALID_ARGUMENT);

  // Implementation
  rmw_init_options_t copy = *src;
  copy.security_options = rmw_get_zero_initialized_security_options();
  copy.discovery_options = rmw_get_zero_initialized_discovery_options();
  copy.enclave = rcutils_strdup(src->enclave, allocator);
  if (src->enclave != nullptr && copy.enclave == nullptr) {
    RMW_SET_ERROR_MSG("out of memory");
    return RMW_RET_BAD_ALLOC;
  }
  auto free_enclave =
    rcpputils::make_scope_exit([&] { allocator.deallocate(copy.enclave, allocator.state); });
  rmw_ret_t result =
    rmw_security_options_copy(&src->security_options, &allocator, &copy.security_options);
  if (result != RMW_RET_OK) {
    return result;
  }
  auto free_security = rcpputils::make_scope_exit(
    [&] { rmw_manycore::ignore(rmw_security_options_fini(&copy.security_options, &allocator)); });
  result = rmw_discovery_options_copy(&src->discovery_options, &allocator, &copy.discovery_options);
  if (result != RMW_RET_OK) {
    return result;
  }
  free_security.cancel();
  free_enclave.cancel();
  *dst = copy;
  return RMW_RET_OK;
}

rmw_ret_t rmw_init_options_fini(rmw_init_options_t * init_options) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(init_options);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    init_options->implementation_identifier, "expected initialized init_options",
    return RMW_RET_INVALID_ARGUMENT);
  MANYCORE_CHECK_HANDLE(init_options);
  rcutils_allocator_t allocator = init_options->allocator;
  RCUTILS_CHECK_ALLOCATOR(&allocator, return RMW_RET_INVALID_ARGUMENT);

  // Implementation
  allocator.deallocate(init_options->enclave, allocator.state);
  const rmw_ret_t security = rmw_security_options_fini(&init_options->security_options, &allocator);
  const rmw_ret_t discovery = rmw_discovery_options_fini(&init_options->discovery_options);
  *init_options = rmw_get_zero_initialized_init_options();
  return security != RMW_RET_OK ? security : discovery;
}
