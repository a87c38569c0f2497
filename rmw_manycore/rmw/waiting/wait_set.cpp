// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/waiting/wait_set.hpp"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/context/context.hpp"
#include "rmw/rmw.h"

namespace rmw_manycore {

WaitSet::WaitSet(rmw_context_t & context)
: process_(context.impl->process), is_shutdown_(context.impl->is_shutdown) {
  handle.implementation_identifier = identifier;
  handle.data = this;
}

}  // namespace rmw_manycore

using rmw_manycore::WaitSet;

rmw_wait_set_t * rmw_create_wait_set(rmw_context_t * context, size_t /*max_conditions*/) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(context->impl, "expected initialized context", return nullptr);

  // Implementation
  return rmw_manycore::guarded_handle([&] { return &(new WaitSet(*context))->handle; });
}

rmw_ret_t rmw_destroy_wait_set(rmw_wait_set_t * wait_set) {
  // Invariants: rmw requires RMW_RET_ERROR for null here
  RMW_CHECK_ARGUMENT_FOR_NULL(wait_set, RMW_RET_ERROR);
  MANYCORE_CHECK_HANDLE(wait_set);

  // Implementation
  delete static_cast<WaitSet *>(wait_set->data);
  return RMW_RET_OK;
}
