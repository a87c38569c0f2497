// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/claim.hpp"

#include <string>
#include <utility>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/subscription/subscription_impl.hpp"

namespace manycore {

Claim::Claim(
  Subscription & subscription, std::unique_lock<HandoverMutex> && lock, Source & source,
  uint64_t number) noexcept
: subscription_(subscription), lock_(std::move(lock)), source_(source), number_(number) {}

/// Step 3 of ROS-lite2 Fig. 4, end: release.
Claim::~Claim() {
  if (!lock_.owns_lock()) {
    return;
  }
  if (subscription_.impl_->membership.is_inherited()) {
    lock_.release();
    return;
  }
  // Read before release(): the topic DSM may be freed after it
  const uint32_t publisher = source_.slot();
  const uint64_t traced = trace_endpoint(publisher, source_.incarnation());
  const bool finished = source_.release(number_);
  subscription_.impl_->registry.tracer().note(
    TraceKind::release, subscription_.impl_->slot, number_, traced);
  subscription_.impl_->settle_after_last();
  lock_.unlock();
  if (finished) {
    subscription_.impl_->sweep(publisher);
  }
}

ZeroCopy Claim::zero_copy() const noexcept { return subscription_.impl_->entry.zero_copy; }

std::optional<Hold> Claim::hold() noexcept {
  Subscription::Impl & impl = *subscription_.impl_;
  if (chunk_ == nullptr || impl.membership.is_inherited() || !impl.holds.may_take(impl.entry.qos)) {
    return std::nullopt;
  }
  return Hold::take(
    {impl.registry, source_.cluster(), source_.row(), impl.entry.process.load()}, *chunk_,
    {data_, size_}, is_for_one_reader_, impl.holds);
}

std::string Claim::reached_limit() const {
  const Subscription::Impl & impl = *subscription_.impl_;
  if (chunk_ == nullptr || impl.membership.is_inherited()) {
    return "";
  }
  const std::string topic = std::string("messages on '") + subscription_.topic() + "' are copied: ";
  if (!impl.holds.may_take(impl.entry.qos)) {
    return topic + "this program keeps " + std::to_string(impl.holds.count()) +
           " of them, the limit of its depth and " + std::to_string(HeldCount::beside_depth) +
           "; drop them earlier, keep copies, such as message.data[:], or raise the depth";
  }
  if (!Hold::leaves_room(source_.cluster(), size_)) {
    return topic + "those that are kept may fill half of cluster " +
           std::to_string(source_.cluster().id()) + ", and " + source_.cluster().fill_level() +
           "; drop messages that programs keep ('manycore status' shows what is held), or raise "
           "smem_size in the mapfile";
  }
  return topic + std::to_string(max_holders) +
         " readers keep the same message, which is the limit; drop messages earlier";
}

void Claim::count_in_place() noexcept {
  const Subscription::Impl & impl = *subscription_.impl_;
  impl.entry.counters.in_place.fetch_add(1, std::memory_order_relaxed);
  impl.registry.tracer().note(
    TraceKind::in_place, impl.slot, number_, trace_endpoint(source_.slot(), source_.incarnation()));
}

void Claim::reject() noexcept {
  Subscription::Impl & impl = *subscription_.impl_;
  impl.counts.count_rejected(size_);
  notify_event_watchers(impl.registry, impl.entry.process);
}

}  // namespace manycore
