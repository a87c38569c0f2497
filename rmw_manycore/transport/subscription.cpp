// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"
#include "transport/matching/closing.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/subscription_impl.hpp"

namespace manycore {

Claim::Claim(Claim && other) noexcept
: subscription_(std::exchange(other.subscription_, nullptr)),
  reader_(other.reader_),
  number_(other.number_),
  data_(other.data_),
  size_(other.size_),
  info_(other.info_) {}

/// Step 3 of Fig. 4, end: release.
Claim::~Claim() {
  if (subscription_ == nullptr || subscription_->impl_->membership.is_inherited()) {
    return;
  }
  Subscription::Impl & impl = *subscription_->impl_;
  const bool finished = reader_->release(number_);
  impl.mutex.unlock();
  if (finished) {
    impl.sweep();
  }
}

void Claim::reject() noexcept { subscription_->impl_->count_rejected(size_); }

Subscription::Subscription(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Subscription::~Subscription() {
  if (impl_->membership.holds()) {
    closing::leave(impl_->registry, impl_->slot);
  }
}

const Gid & Subscription::gid() const noexcept { return impl_->entry.gid; }

const Qos & Subscription::qos() const noexcept { return impl_->entry.qos; }

const char * Subscription::topic() const noexcept { return impl_->entry.topic; }

const char * Subscription::type() const noexcept { return impl_->entry.type; }

bool Subscription::has_data() const noexcept {
  return !subscriber_queue::empty(impl_->header) ||
         impl_->backlog_size.load(std::memory_order_relaxed) != 0 ||
         impl_->header.resync.load(std::memory_order_acquire) != 0;
}

std::optional<Claim> Subscription::claim() {
  Impl & impl = *impl_;
  impl.membership.require();
  std::unique_lock<std::mutex> lock(impl.mutex);
  while (const auto candidate = impl.next()) {
    TopicDsmReader::View view;
    switch (candidate->reader->claim(candidate->number, view)) {
      case TopicDsmReader::ClaimResult::gone:
        impl.unsettled = true;
        impl.count_lost_replies(1);
        continue;
      case TopicDsmReader::ClaimResult::expired:
        impl.entry.counters.expired.fetch_add(1, std::memory_order_relaxed);
        continue;
      case TopicDsmReader::ClaimResult::not_ours:
        continue;
      case TopicDsmReader::ClaimResult::claimed:
        break;
    }
    ++impl.received;
    impl.count_taken(view.record->size_bytes);
    Claim claim;
    claim.subscription_ = this;
    claim.reader_ = candidate->reader;
    claim.number_ = candidate->number;
    claim.data_ = view.data;
    claim.size_ = view.record->size_bytes;
    claim.info_.source_timestamp_ns =
      view.record->source_timestamp_ns.load(std::memory_order_relaxed);
    claim.info_.received_timestamp_ns = realtime_ns();
    claim.info_.publication_sequence_number = view.record->publication_sequence_number;
    claim.info_.reception_sequence_number = impl.received;
    claim.info_.publisher = candidate->reader->publisher();
    claim.info_.correlation = view.record->correlation;
    claim.info_.from_this_process = candidate->reader->publisher_process() == impl.entry.process;
    lock.release();
    return claim;
  }
  return std::nullopt;
}

uint64_t Subscription::arrivals() const noexcept {
  Impl & impl = *impl_;
  if (impl.header.resync.load(std::memory_order_acquire) != 0) {
    const std::lock_guard<std::mutex> lock(impl.mutex);
    impl.resync_if_asked();
  }
  const uint64_t pushed =
    impl.header.tail.load(std::memory_order_acquire) - (uint64_t{1} << impl.header.slot_count_log2);
  return pushed + impl.arrivals_by_resync.load(std::memory_order_relaxed);
}

uint64_t Subscription::waiting() const noexcept {
  return subscriber_queue::size(impl_->header) +
         impl_->backlog_size.load(std::memory_order_relaxed);
}

uint64_t Subscription::lost() const noexcept {
  // What displaced hints suggest may turn out to be too much; a count of lost messages never falls.
  const uint64_t now = lost_so_far(impl_->entry, impl_->header);
  uint64_t reported = impl_->reported_lost.load(std::memory_order_relaxed);
  while (reported < now && !impl_->reported_lost.compare_exchange_weak(reported, now)) {
  }
  return std::max(reported, now);
}

MatchedCount Subscription::matched() const { return matched_of(impl_->entry); }

IncompatibleCount Subscription::incompatible() const { return incompatible_of(impl_->entry); }

uint64_t Subscription::incompatible_types() const noexcept {
  return impl_->entry.incompatible_types.load();
}

TimedCount Subscription::deadline_missed() const noexcept {
  const SubscriptionHeader & header = impl_->header;
  return header.has_deadline != 0 ? header.deadline.missed(header.deadline_ns) : TimedCount{};
}

LivelinessCount Subscription::liveliness() const {
  return liveliness_of(impl_->registry, impl_->entry);
}

}  // namespace manycore
