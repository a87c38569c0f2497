// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/publisher/publisher.hpp"

#include <utility>

#include "transport/matching/leaving.hpp"
#include "transport/notification/notifier.hpp"
#include "transport/publisher/lent.hpp"
#include "transport/publisher/publisher_impl.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore {

Publisher::Publisher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Publisher::~Publisher() {
  if (impl_->membership.holds()) {
    leave_graph(impl_->registry, impl_->slot);
  }
}

const Gid & Publisher::gid() const noexcept { return impl_->entry.gid; }

uint32_t Publisher::slot() const noexcept { return impl_->slot; }

const Qos & Publisher::qos() const noexcept { return impl_->entry.qos; }

Draft Publisher::draft(size_t size_bytes) {
  Impl & impl = *impl_;
  impl.membership.require();
  Tracer & tracer = impl.registry.tracer();
  tracer.note(TraceKind::publish_begin, impl.slot, 0, size_bytes);
  try {
    Draft draft(impl.write(), impl.writer, size_bytes);
    tracer.note(TraceKind::serialize_begin, impl.slot, impl.writer.next_number());
    return draft;
  } catch (...) {
    tracer.note(TraceKind::refused, impl.slot);
    throw;
  }
}

uint64_t Publisher::publish(
  Draft && draft, size_t size_bytes, int64_t source_timestamp_ns, const Correlation & correlation,
  const WakeSet & spared) {
  const Writing writing = std::move(draft.writing_);
  return impl_->publish({size_bytes, source_timestamp_ns, correlation}, spared);
}

std::optional<Loan> Publisher::lend(size_t size_bytes) {
  Impl & impl = *impl_;
  impl.membership.require();
  if (!impl.writer.has_chunks()) {
    return std::nullopt;
  }
  auto lent = std::make_unique<Loan::Lent>(Loan::Lent{impl, {}});
  const Writing writing = impl.write();
  lent->chunk = impl.writer.lend(size_bytes);
  return Loan(std::move(lent));
}

uint64_t Publisher::publish(Loan && loan, size_t size_bytes, int64_t source_timestamp_ns) {
  Impl & impl = *impl_;
  Loan ended = std::move(loan);
  impl.membership.require();
  impl.registry.tracer().note(TraceKind::publish_begin, impl.slot, 0, size_bytes);
  const Writing writing = impl.write();
  impl.writer.take_back(ended.lent_->chunk);
  ended.lent_.reset();
  impl.registry.tracer().note(
    TraceKind::in_place, impl.slot, impl.writer.next_number(),
    trace_endpoint(impl.slot, impl.entry.slot.incarnation));
  const uint64_t sequence_number = impl.publish({size_bytes, source_timestamp_ns, {}}, {});
  impl.entry.counters.in_place.fetch_add(1, std::memory_order_relaxed);
  return sequence_number;
}

/// The room is found, and filled.
uint64_t Publisher::Impl::publish(const Written & written, const WakeSet & spared) {
  const uint64_t sequence_number = ++published;
  // Touch both clocks before the message wakes readers that check them.
  const bool started = has_deadline() && deadline.touch(entry.qos.deadline_ns);
  const bool revived = is_manual() && liveliness.assert_now();
  if (started || revived) {  // wake waiters: a deadline or lease just started
    manycore::notify_event_watchers(registry, entry.process);
  }
  trace_write(written.size_bytes, written.correlation);
  const uint64_t number = writer.commit(
    written.size_bytes, written.source_timestamp_ns, sequence_number, written.correlation);
  const bool targeted = entry.role == EndpointRole::reply;
  announce(
    registry, cluster, writer.readers(),
    {entry.block, slot, entry.slot.incarnation, number,
     targeted ? &written.correlation.client : nullptr, &registry.processes()[entry.process].wake,
     spared},
    sender);
  if (revived) {
    notify_readers_of_event();
  }
  registry.tracer().note(TraceKind::publish_end, slot, number);
  EndpointCounters & counters = entry.counters;
  counters.messages.store(sequence_number, std::memory_order_relaxed);
  counters.bytes.store(
    counters.bytes.load(std::memory_order_relaxed) + written.size_bytes, std::memory_order_relaxed);
  sender.require_received();
  return sequence_number;
}

Transfer Publisher::transfer() const noexcept { return impl_->entry.transfer; }

MatchedCount Publisher::matched() const { return impl_->matches.matched(); }

IncompatibleCount Publisher::incompatible() const { return impl_->matches.incompatible(); }

uint64_t Publisher::incompatible_types() const noexcept {
  return impl_->matches.incompatible_types();
}

TimedCount Publisher::deadline_missed() const noexcept {
  return impl_->has_deadline() ? impl_->deadline.missed(impl_->entry.qos.deadline_ns)
                               : TimedCount{};
}

TimedCount Publisher::liveliness_lost() const noexcept {
  return impl_->is_manual() ? impl_->liveliness.lost() : TimedCount{};
}

void Publisher::assert_liveliness() {
  impl_->membership.require();
  if (impl_->is_manual() && impl_->liveliness.assert_now()) {
    impl_->notify_event_watchers();
    notify_event_watchers(impl_->registry, impl_->entry.process);
  }
}

/// Called before readers can see the record, so that their events are later.
void Publisher::Impl::trace_write(size_t size_bytes, const Correlation & correlation) noexcept {
  Tracer & tracer = registry.tracer();
  tracer.note(TraceKind::write, slot, writer.next_number(), size_bytes);
  if (entry.role != EndpointRole::topic) {
    const bool asks = entry.role == EndpointRole::request;
    tracer.note(
      asks ? TraceKind::request : TraceKind::reply, slot, writer.next_number(),
      static_cast<uint64_t>(correlation.number));
  }
}

void Publisher::Impl::notify_event_watchers() {
  const Writing writing = write();
  notify_readers_of_event();
}

/// Wakes all processes if the list of readers lacks some.
void Publisher::Impl::notify_readers_of_event() noexcept {
  if (!writer.readers().is_complete()) {
    for (uint32_t process = 0; process < registry.processes().high_water(); ++process) {
      manycore::notify_event_watchers(registry, process);
    }
    return;
  }
  for (const Reader & reader : writer.readers().all()) {
    reader.wake->notify_events();
  }
}

}  // namespace manycore
