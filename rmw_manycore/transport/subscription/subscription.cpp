// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/subscription.hpp"

#include <new>
#include <utility>
#include <vector>

#include "transport/matching/leaving.hpp"
#include "transport/matching/sweeping.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/subscription/subscription_impl.hpp"
#include "virtual_time/door.hpp"

namespace manycore {

namespace {

/// Traces the messages found missing during its lifetime, and wakes threads that wait for the
/// event of lost ones.
class LossNotice {
public:
  explicit LossNotice(Subscription::Impl & impl) noexcept : impl_(impl), before_(now()) {}
  ~LossNotice() {
    const auto [lost, superseded] = now();
    if (superseded != before_.superseded) {
      impl_.registry.tracer().note(
        TraceKind::superseded, impl_.slot, 0, superseded - before_.superseded);
    }
    if (lost != before_.lost) {
      impl_.registry.tracer().note(TraceKind::lost, impl_.slot, 0, lost - before_.lost);
      notify_event_watchers(impl_.registry, impl_.entry.process);
    }
  }
  LossNotice(const LossNotice &) = delete;
  LossNotice & operator=(const LossNotice &) = delete;

private:
  Missed now() const noexcept {
    const EndpointCounters & counters = impl_.entry.counters;
    return {
      counters.lost.load(std::memory_order_relaxed),
      counters.superseded.load(std::memory_order_relaxed)};
  }

  Subscription::Impl & impl_;
  const Missed before_;
};

/// Frees, at its end, topic DSMs that waited for this subscription only.
class FinishedPublishers {
public:
  explicit FinishedPublishers(Subscription::Impl & impl) noexcept : impl_(impl) {}
  ~FinishedPublishers() {
    for (const uint32_t slot : slots_) {
      impl_.sweep(slot);
    }
  }
  FinishedPublishers(const FinishedPublishers &) = delete;
  FinishedPublishers & operator=(const FinishedPublishers &) = delete;

  void add(uint32_t slot) noexcept {
    try {
      slots_.push_back(slot);
    } catch (const std::bad_alloc &) {
      impl_.cluster.wake_reaper();
    }
  }

private:
  Subscription::Impl & impl_;
  std::vector<uint32_t> slots_;
};

}  // namespace

Subscription::Subscription(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Subscription::~Subscription() {
  if (impl_->membership.holds()) {
    leave_graph(impl_->registry, impl_->slot);
  }
}

const Gid & Subscription::gid() const noexcept { return impl_->entry.gid; }

const Qos & Subscription::qos() const noexcept { return impl_->entry.qos; }

Transfer Subscription::transfer() const noexcept { return impl_->entry.transfer; }

const char * Subscription::topic() const noexcept { return impl_->entry.topic; }

const char * Subscription::type() const noexcept { return impl_->entry.type; }

bool Subscription::has_data() const noexcept {
  return impl_->finder.has_records() && !is_under_way();
}

bool Subscription::is_under_way() const noexcept {
  const uint32_t incarnation = impl_->entry.slot.incarnation.load(std::memory_order_relaxed);
  return !virtual_time::has_arrived(impl_->slot, incarnation);
}

Watchers & Subscription::watchers() noexcept { return impl_->header.watchers; }

std::optional<Claim> Subscription::claim() {
  Impl & impl = *impl_;
  impl.membership.require();
  const virtual_time::Door * const door = virtual_time::door();
  if (
    door != nullptr && impl.finder.has_records() &&
    !door->elapse(virtual_time::Step::take, impl.slot)) {
    // The run is ending. What has a signal to handle, as Python, returns from a take first: it may
    // handle it where it makes an object of the message.
    return std::nullopt;
  }
  FinishedPublishers finished(impl);
  std::unique_lock<HandoverMutex> lock(impl.mutex);
  const LossNotice losses(impl);
  while (const auto candidate = impl.finder.next()) {
    Source & source = *candidate->source;
    Source::View view;
    // Before the claim, after which the topic DSM may be freed.
    const uint32_t publisher = source.slot();
    const uint64_t traced = trace_endpoint(publisher, source.incarnation());
    const Source::Claimed claimed = source.claim(candidate->wanted, view);
    if (claimed.is_finished) {
      finished.add(publisher);
    }
    switch (claimed.result) {
      case Source::ClaimResult::gone:
        impl.counts.suspect_losses();
        continue;
      case Source::ClaimResult::expired:
        impl.counts.count_expired();
        impl.registry.tracer().note(TraceKind::expired, impl.slot, view.number, traced);
        continue;
      case Source::ClaimResult::not_ours:
        continue;
      case Source::ClaimResult::claimed:
        break;
    }
    Claim claim(*this, std::move(lock), source, view.number);
    claim.data_ = view.data;
    claim.chunk_ = view.chunk;
    claim.is_for_one_reader_ = view.is_for_one_reader;
    claim.size_ = view.record->size_bytes;
    claim.info_.source_timestamp_ns = view.record->source_timestamp_ns;
    claim.info_.received_timestamp_ns = stamp_now_ns();
    claim.info_.publication_sequence_number = view.record->publication_sequence_number;
    claim.info_.reception_sequence_number = impl.counts.count_taken(claim.size_);
    claim.info_.publisher = source.publisher();
    claim.info_.correlation = view.record->correlation;
    claim.info_.from_this_process = source.publisher_process() == impl.entry.process;
    impl.trace_claim(claim.info_, view.number, traced);
    return claim;
  }
  return std::nullopt;
}

uint64_t Subscription::arrivals() const noexcept {
  Impl & impl = *impl_;
  if (impl.finder.has_to_resync()) {
    const std::lock_guard<HandoverMutex> lock(impl.mutex);
    const LossNotice losses(impl);
    try {
      impl.finder.resync_if_asked();
    } catch (const std::bad_alloc &) {
      // Out of memory: the next take retries, or reports the error.
    }
  }
  return impl.finder.arrivals();
}

uint64_t Subscription::announced() const noexcept { return impl_->finder.arrivals(); }

bool Subscription::has_to_resync() const noexcept { return impl_->finder.has_to_resync(); }

uint64_t Subscription::waiting() const noexcept { return impl_->finder.waiting(); }

uint64_t Subscription::lost() const noexcept { return impl_->counts.lost(); }

uint64_t Subscription::superseded() const noexcept { return impl_->counts.superseded(); }

MatchedCount Subscription::matched() const { return impl_->matches.matched(); }

IncompatibleCount Subscription::incompatible() const { return impl_->matches.incompatible(); }

uint64_t Subscription::incompatible_types() const noexcept {
  return impl_->matches.incompatible_types();
}

TimedCount Subscription::deadline_missed() const noexcept {
  const SubscriptionHeader & header = impl_->header;
  return header.has_deadline != 0 ? header.deadline.missed(header.deadline_ns) : TimedCount{};
}

LivelinessCount Subscription::liveliness() const {
  return liveliness_of(impl_->registry, impl_->matches, impl_->entry.qos.liveliness_lease_ns);
}

void Subscription::Impl::trace_claim(
  const RecordInfo & info, uint64_t number, uint64_t publisher) noexcept {
  Tracer & tracer = registry.tracer();
  tracer.note(TraceKind::claim, slot, number, publisher);
  if (entry.role != EndpointRole::topic) {
    const bool asked = entry.role == EndpointRole::request;
    tracer.note(
      asked ? TraceKind::request : TraceKind::reply, slot, number,
      static_cast<uint64_t>(info.correlation.number));
  }
}

void Subscription::Impl::settle_after_last() noexcept {
  // Displaced hints alone are counted already.
  if (counts.is_unsettled() && !finder.has_records()) {
    const LossNotice losses(*this);
    finder.settle();
  }
}

void Subscription::Impl::sweep(uint32_t publisher) noexcept {
  sweeping::try_to_sweep(registry, publisher, cluster);
}

}  // namespace manycore
