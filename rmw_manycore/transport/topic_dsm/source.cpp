// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/source.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "transport/queue/displaced.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"

namespace manycore {
namespace {

/// Sorts by number and makes timestamps monotonic, so that merging sources by timestamp keeps the
/// order of each source even if CLOCK_REALTIME was set back.
void order(std::vector<Source::Waiting> & all, ptrdiff_t begin) {
  using Waiting = Source::Waiting;
  std::sort(all.begin() + begin, all.end(), [](const Waiting & a, const Waiting & b) {
    return a.number < b.number;
  });
  for (auto i = static_cast<size_t>(begin) + 1; i < all.size(); ++i) {
    all[i].source_timestamp_ns =
      std::max(all[i].source_timestamp_ns, all[i - 1].source_timestamp_ns);
  }
}

}  // namespace

Source::Source(Registry & registry, SourceEntry & entry, Use use, EndpointEntry & subscription)
: entry_(&entry),
  index_(use.index),
  incarnation_(use.incarnation),
  noted_(entry.taken.load(std::memory_order_relaxed)),
  subscription_(&subscription) {
  const SegmentRef ref{entry.topic_dsm.load(std::memory_order_relaxed)};
  cluster_ = registry.clusters().find(ref.cluster());
  own_cluster_ = registry.clusters().find(subscription.cluster);
  dsm_ = registry.clusters().find<TopicDsmHeader>(ref);
}

bool Source::is_given_up(uint64_t number) const noexcept {
  return subscription_->role == EndpointRole::reply &&
         Displaced::covers(entry_->displaced, incarnation_, number);
}

std::optional<uint64_t> Source::published_number(uint64_t low_bits) noexcept {
  std::optional<uint64_t> number;
  entry_->reading.store(header_only, std::memory_order_seq_cst);
  if (may_look()) {
    const uint64_t latest = arrived().last();  // load once: it increases concurrently
    number = Hint::full_number(low_bits, latest);
    if (*number > latest) {
      number.reset();
    }
  }
  entry_->reading.store(no_record, std::memory_order_release);
  return number;
}

/// Dekker with retire(): `first` is loaded after `reading` is stored, both seq_cst. A generation
/// that holds `number` and is still open here is therefore not freed before the claim ends. If this
/// generation was chosen because a younger one was closed concurrently, it is protected if it is
/// still open in the second load.
const GenerationEntry * Source::generation_of(uint64_t number) const noexcept {
  const GenerationEntry * best = nullptr;
  uint64_t best_first = 0;
  for (const GenerationEntry & generation : dsm_->generations) {
    const uint64_t first = generation.first.load(std::memory_order_seq_cst);
    if (first != 0 && first <= number && first > best_first) {
      best = &generation;
      best_first = first;
    }
  }
  return best != nullptr && best->first.load(std::memory_order_seq_cst) == best_first ? best
                                                                                      : nullptr;
}

Source::Descriptors Source::descriptors_of(const GenerationEntry & generation) const noexcept {
  const uint64_t count = generation.descriptor_count.load(std::memory_order_relaxed);
  if (count == 0 || (count & (count - 1)) != 0) {
    return {};
  }
  auto * const begin = cluster_->find<RecordDescriptor>(
    generation.offset.load(std::memory_order_relaxed), count * sizeof(RecordDescriptor));
  return begin == nullptr ? Descriptors{} : Descriptors{begin, count};
}

bool Source::is_for_us(const RecordDescriptor & record) const noexcept {
  return static_cast<EndpointRole>(dsm_->role) != EndpointRole::reply ||
         record.correlation.client == subscription_->gid;
}

/// The shorter lifespan of publisher and subscription applies.
bool Source::is_expired(const RecordDescriptor & record) const noexcept {
  const int64_t lifespan_ns = std::min(dsm_->lifespan_ns, subscription_->qos.lifespan_ns);
  return lifespan_ns != infinite_ns &&
         realtime_ns() - record.source_timestamp_ns.load(std::memory_order_relaxed) > lifespan_ns;
}

bool Source::may_look() const noexcept {
  return entry_->state.load(std::memory_order_seq_cst) == SourceState::active &&
         entry_->incarnation.load(std::memory_order_seq_cst) == incarnation_;
}

/// Dekker with reclaim(): `reading` is stored before `number` is loaded, both seq_cst, so either
/// the publisher sees the claim and leaves the bytes alone, or this reader sees that the number is
/// gone. The same holds for revoke() and the state of the source: the topic DSM is accessed only if
/// the state is still `active` after the store.
Source::Claimed Source::claim(uint64_t number, View & view) noexcept {
  entry_->reading.store(number, std::memory_order_seq_cst);
  if (!may_look()) {
    entry_->reading.store(no_record, std::memory_order_release);
    return {ClaimResult::not_ours, false};
  }
  const ClaimResult result = look_at(number, view);
  return {result, result != ClaimResult::claimed && release(number)};
}

Source::ClaimResult Source::look_at(uint64_t number, View & view) noexcept {
  const GenerationEntry * const generation = generation_of(number);
  const Descriptors descriptors =
    generation == nullptr ? Descriptors{} : descriptors_of(*generation);
  if (descriptors.count == 0) {
    return ClaimResult::gone;
  }
  RecordDescriptor & record = descriptors.begin[number & (descriptors.count - 1)];
  if (record.number.load(std::memory_order_seq_cst) != number) {
    return ClaimResult::gone;
  }
  const uint8_t * const data = arrived().find(*generation, record, number);
  if (data == nullptr) {
    return ClaimResult::gone;
  }
  if (!is_for_us(record)) {
    return ClaimResult::not_ours;
  }
  count_missing(record.publication_sequence_number - 1);
  account_for(record.publication_sequence_number);
  if (is_expired(record)) {
    return ClaimResult::expired;
  }
  view.record = &record;
  view.data = data;
  return ClaimResult::claimed;
}

/// Stores `reading` last: once it is empty, the topic DSM may be freed. The publisher waits for
/// `taken` only, so it is notified before that. `taken` is stored seq_cst: the publisher sets
/// `writer_waits` before it loads `taken` again.
bool Source::release(uint64_t number) noexcept {
  if (number > entry_->taken.load(std::memory_order_relaxed)) {
    entry_->taken.store(number, std::memory_order_seq_cst);
  }
  if (number > noted_) {
    noted_ = number;
  }
  notify_waiting_publisher(*dsm_);
  const bool finished = is_finished();
  if (finished) {  // last access to the topic DSM
    const LastPublished published = last_published(*dsm_);
    if (published.exact) {
      count_missing(published.sequence);
    }
  }
  // seq_cst: revoke() stores the state before it loads `reading`.
  entry_->reading.store(no_record, std::memory_order_seq_cst);
  return finished || entry_->state.load(std::memory_order_seq_cst) == SourceState::revoked;
}

bool Source::skip(uint64_t number) noexcept {
  entry_->reading.store(header_only, std::memory_order_seq_cst);
  const bool is_over = may_look() && release(number);
  entry_->reading.store(no_record, std::memory_order_release);
  return is_over;
}

/// Pins the generation, then one record after the other in it, so a reader that is stopped in a
/// scan costs at most what a claim costs: one record, and no younger generation. Dekker with
/// retire(), as in generation_of(): a generation that is still open in the second load is not freed
/// while `reading` names it or a record in it.
void Source::scan(
  const GenerationEntry & generation, const transfer::Arrived & arrived, uint64_t last,
  std::vector<Waiting> & out) noexcept {
  const uint64_t first = generation.first.load(std::memory_order_seq_cst);
  if (first == 0 || first > last) {
    return;
  }
  entry_->reading.store(whole_generation | first, std::memory_order_seq_cst);
  const bool is_open = generation.first.load(std::memory_order_seq_cst) == first;
  const Descriptors descriptors = is_open ? descriptors_of(generation) : Descriptors{};
  for (uint64_t i = 0; i < descriptors.count; ++i) {
    RecordDescriptor & record = descriptors.begin[i];
    const uint64_t number = record.number.load(std::memory_order_relaxed);
    if (number <= noted_ || number > last || is_given_up(number) || !arrived.has(number)) {
      continue;
    }
    entry_->reading.store(number, std::memory_order_seq_cst);
    if (record.number.load(std::memory_order_seq_cst) == number && is_for_us(record)) {
      out.push_back(
        {record.source_timestamp_ns.load(std::memory_order_relaxed), number, index_, incarnation_});
    }
  }
}

void Source::list_waiting(std::vector<Waiting> & out) noexcept {
  const auto own_part = static_cast<ptrdiff_t>(out.size());
  entry_->reading.store(header_only, std::memory_order_seq_cst);
  if (may_look()) {
    // Most sources have no new record: a subscription resyncs for each publisher that joins.
    const transfer::Arrived arrived = this->arrived();
    if (const uint64_t last = arrived.last(); last > noted_) {
      for (const GenerationEntry & generation : dsm_->generations) {
        scan(generation, arrived, last, out);
      }
      noted_ = last;
    }
  }
  entry_->reading.store(no_record, std::memory_order_release);
  order(out, own_part);
}

/// Sequence numbers count the replies to all clients; see ReceptionCounts::count_lost_replies().
void Source::count_missing(uint64_t last_sequence) noexcept {
  const uint64_t missing = account_for(last_sequence);
  if (missing != 0 && static_cast<EndpointRole>(dsm_->role) != EndpointRole::reply) {
    subscription_->counters.lost.fetch_add(missing, std::memory_order_relaxed);
  }
}

uint64_t Source::account_for(uint64_t last_sequence) noexcept {
  const uint64_t before = entry_->accounted.load(std::memory_order_relaxed);
  if (last_sequence <= before) {
    return 0;
  }
  entry_->accounted.store(last_sequence, std::memory_order_relaxed);
  return last_sequence - before;
}

Source::Settled Source::settle() noexcept {
  Settled settled = Settled::no;
  entry_->reading.store(header_only, std::memory_order_seq_cst);
  if (may_look()) {
    const LastPublished published = last_published(*dsm_);
    const std::optional<uint64_t> displaced = Displaced::read(entry_->displaced, incarnation_);
    const transfer::Arrived arrived = this->arrived();
    const uint64_t known =
      displaced ? std::max(noted_, Hint::full_number(*displaced, arrived.last())) : noted_;
    if (published.exact && arrived.is_settled(published.number, known)) {
      count_missing(published.sequence);
      const bool was_finished = is_finished();
      // Records counted as lost must not be found by a later scan.
      const bool is_over = release(published.number);
      // Revoked meanwhile: this look may have stood in a sweeper's way.
      const bool is_revoked = entry_->state.load(std::memory_order_seq_cst) == SourceState::revoked;
      settled = is_over && (!was_finished || is_revoked) ? Settled::finished : Settled::yes;
    }
  }
  entry_->reading.store(no_record, std::memory_order_release);
  return settled;
}

bool Source::is_finished() const noexcept {
  return dsm_->orphan.load(std::memory_order_acquire) != 0 &&
         entry_->taken.load(std::memory_order_relaxed) >=
           dsm_->last.load(std::memory_order_acquire);
}

}  // namespace manycore
