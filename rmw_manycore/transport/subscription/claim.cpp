// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/claim.hpp"

#include <utility>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/subscription/subscription_impl.hpp"

namespace manycore {

Claim::Claim(
  Subscription & subscription, std::unique_lock<std::mutex> && lock, Source & source,
  uint64_t number) noexcept
: subscription_(subscription), lock_(std::move(lock)), source_(source), number_(number) {}

/// Step 3 of Fig. 4, end: release.
Claim::~Claim() {
  if (!lock_.owns_lock()) {
    return;
  }
  if (subscription_.impl_->membership.is_inherited()) {
    lock_.release();
    return;
  }
  const uint32_t publisher = source_.publisher_slot();  // before the topic DSM may go
  const bool finished = source_.release(number_);
  subscription_.impl_->registry.tracer().note(
    TraceKind::release, subscription_.impl_->slot, number_, endpoint_in(info_.publisher));
  lock_.unlock();
  if (finished) {
    subscription_.impl_->sweep(publisher);
  }
}

void Claim::reject() noexcept {
  Subscription::Impl & impl = *subscription_.impl_;
  impl.counts.count_rejected(size_);
  notify_event_watchers(impl.registry, impl.entry.process);
}

}  // namespace manycore
