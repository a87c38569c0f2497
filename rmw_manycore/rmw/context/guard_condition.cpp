// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/context/guard_condition.hpp"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/context/context.hpp"
#include "rmw/rmw.h"

namespace rmw_manycore {

GuardCondition::GuardCondition(rmw_context_t & context, Source source)
: process_(context.impl->process),
  source_(source),
  watched_(process_->waiters(), watchers_),
  seen_generation_(process_->graph().generation()) {
  handle.implementation_identifier = identifier;
  handle.data = this;
  handle.context = &context;
}

void GuardCondition::trigger() noexcept {
  triggered_.store(true, std::memory_order_seq_cst);
  if (!process_->is_inherited()) {
    process_->waiters().notify(watchers_);
  }
}

bool GuardCondition::ready() const noexcept {
  return triggered_.load(std::memory_order_seq_cst) ||
         (source_ == Source::graph &&
          seen_generation_.load(std::memory_order_relaxed) != process_->graph().generation());
}

bool GuardCondition::take() noexcept {
  const bool triggered = triggered_.exchange(false, std::memory_order_acq_rel);
  if (source_ != Source::graph) {
    return triggered;
  }
  const uint64_t generation = process_->graph().generation();
  return seen_generation_.exchange(generation, std::memory_order_relaxed) != generation ||
         triggered;
}

}  // namespace rmw_manycore

using rmw_manycore::GuardCondition;

rmw_guard_condition_t * rmw_create_guard_condition(rmw_context_t * context) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(context->impl, "expected initialized context", return nullptr);

  // Implementation
  return rmw_manycore::guarded_handle(
    [&] { return &(new GuardCondition(*context, GuardCondition::Source::trigger))->handle; });
}

rmw_ret_t rmw_destroy_guard_condition(rmw_guard_condition_t * guard_condition) {
  // Invariants
  MANYCORE_CHECK_HANDLE(guard_condition);

  // Implementation
  delete static_cast<GuardCondition *>(guard_condition->data);
  return RMW_RET_OK;
}

rmw_ret_t rmw_trigger_guard_condition(const rmw_guard_condition_t * guard_condition) {
  // Invariants
  MANYCORE_CHECK_HANDLE(guard_condition);

  // Implementation
  static_cast<GuardCondition *>(guard_condition->data)->trigger();
  return RMW_RET_OK;
}
