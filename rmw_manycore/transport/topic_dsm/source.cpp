// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/source.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "transport/queue/displaced.hpp"
#include "transport/topic_dsm/last_published.hpp"

namespace manycore {
namespace {

/// By number; and no timestamp before an earlier record's, so that merging sources keeps each one's
/// order even where the clock was set back.
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
  dsm_ = registry.clusters().find<TopicDsmHeader>(ref);
}

bool Source::is_given_up(uint64_t number) const noexcept {
  return subscription_->role == EndpointRole::reply &&
         Displaced::covers(entry_->displaced, incarnation_, number);
}

/// The latest published with these low bits: what a queue holds is younger than a period, however
/// long nothing was taken. Where nothing was published with them it wraps to more than `latest`.
uint64_t Source::full_number(uint64_t low_bits, uint64_t latest) noexcept {
  constexpr uint64_t period = uint64_t{1} << 28;
  return latest - ((latest - low_bits) & (period - 1));
}

std::optional<uint64_t> Source::published_number(uint64_t low_bits) noexcept {
  std::optional<uint64_t> number;
  entry_->reading.store(every_record, std::memory_order_seq_cst);
  if (may_look()) {
    const uint64_t latest = last();  // once: it rises meanwhile
    number = full_number(low_bits, latest);
    if (*number > latest) {
      number.reset();
    }
  }
  entry_->reading.store(no_record, std::memory_order_release);
  return number;
}

/// Dekker with retire(): `first` is loaded after `reading` is stored, both seq_cst, so a generation
/// that holds `number` and is still open here is not given back before the claim ends. One that is
/// chosen because a younger one was closed meanwhile is protected if it is open after that.
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

/// The shorter of the publisher's lifespan and the subscription's counts.
bool Source::is_expired(const RecordDescriptor & record) const noexcept {
  const int64_t lifespan_ns = std::min(dsm_->lifespan_ns, subscription_->qos.lifespan_ns);
  return lifespan_ns != infinite_ns &&
         realtime_ns() - record.source_timestamp_ns.load(std::memory_order_relaxed) > lifespan_ns;
}

bool Source::may_look() const noexcept {
  return entry_->state.load(std::memory_order_seq_cst) == SourceState::active &&
         entry_->incarnation.load(std::memory_order_seq_cst) == incarnation_;
}

/// Dekker with take_back(): `reading` is stored before `number` is loaded, both seq_cst, so either
/// the publisher sees the claim and leaves the bytes alone, or the number is gone here. The same
/// with revoke() and the source's state: nothing of the topic DSM is touched unless the state was
/// still `active` after the store.
Source::ClaimResult Source::claim(uint64_t number, View & view) noexcept {
  entry_->reading.store(number, std::memory_order_seq_cst);
  if (!may_look()) {
    entry_->reading.store(no_record, std::memory_order_release);
    return ClaimResult::not_ours;
  }
  const ClaimResult result = look_at(number, view);
  if (result != ClaimResult::claimed) {
    release(number);
  }
  return result;
}

Source::ClaimResult Source::look_at(uint64_t number, View & view) noexcept {
  const GenerationEntry * const generation = generation_of(number);
  const Descriptors descriptors =
    generation == nullptr ? Descriptors{} : descriptors_of(*generation);
  if (descriptors.count == 0) {
    return ClaimResult::gone;
  }
  RecordDescriptor & record = descriptors.begin[number & (descriptors.count - 1)];
  if (
    record.number.load(std::memory_order_seq_cst) != number ||
    !cluster_->contains(record.offset, record.size_bytes)) {
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
  view.data = cluster_->find<uint8_t>(record.offset, record.size_bytes);
  return ClaimResult::claimed;
}

/// `reading` last: once it is empty the topic DSM may be freed. The publisher waits for `taken`
/// only, so it is told in time (seq_cst: it raises `writer_waits` before it looks at `taken` once
/// more).
bool Source::release(uint64_t number) noexcept {
  if (number > entry_->taken.load(std::memory_order_relaxed)) {
    entry_->taken.store(number, std::memory_order_seq_cst);
  }
  if (number > noted_) {
    noted_ = number;
  }
  tell_waiting_publisher();
  const bool finished = is_finished();
  if (finished) {  // the last look at it
    const LastPublished published = last_published(*dsm_);
    if (published.exact) {
      count_missing(published.sequence);
    }
  }
  // seq_cst: revoke() stores the state before it looks at `reading`.
  entry_->reading.store(no_record, std::memory_order_seq_cst);
  return finished || entry_->state.load(std::memory_order_seq_cst) == SourceState::revoked;
}

void Source::skip(uint64_t number) noexcept {
  entry_->reading.store(every_record, std::memory_order_seq_cst);
  if (may_look()) {
    release(number);
  }
  entry_->reading.store(no_record, std::memory_order_release);
}

void Source::tell_waiting_publisher() noexcept {
  if (dsm_->writer_waits.load(std::memory_order_seq_cst) != 0) {
    dsm_->progress.fetch_add(1, std::memory_order_seq_cst);
    futex_wake_all(dsm_->progress);
  }
}

uint64_t Source::last() const noexcept { return dsm_->last.load(std::memory_order_seq_cst); }

/// Holds one record after the other, so that a scan that is stopped costs one record like any
/// claim. The generation is held all the time: each value of `reading` is inside it.
void Source::scan(
  const GenerationEntry & generation, uint64_t last, std::vector<Waiting> & out) noexcept {
  entry_->reading.store(every_record, std::memory_order_seq_cst);
  const bool open = generation.first.load(std::memory_order_seq_cst) != 0;
  const Descriptors descriptors = open ? descriptors_of(generation) : Descriptors{};
  for (uint64_t i = 0; i < descriptors.count; ++i) {
    RecordDescriptor & record = descriptors.begin[i];
    const uint64_t number = record.number.load(std::memory_order_relaxed);
    if (number <= noted_ || number > last || is_given_up(number)) {
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
  entry_->reading.store(every_record, std::memory_order_seq_cst);
  if (may_look()) {
    const uint64_t last = dsm_->last.load(std::memory_order_seq_cst);
    for (const GenerationEntry & generation : dsm_->generations) {
      scan(generation, last, out);
    }
    noted_ = std::max(noted_, last);
  }
  entry_->reading.store(no_record, std::memory_order_release);
  order(out, own_part);
}

/// Sequence numbers count the replies to all clients: see ReceptionCounts::count_lost_replies().
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

bool Source::settle() noexcept {
  bool settled = false;
  entry_->reading.store(every_record, std::memory_order_seq_cst);
  if (may_look()) {
    const LastPublished published = last_published(*dsm_);
    const std::optional<uint64_t> displaced = Displaced::read(entry_->displaced, incarnation_);
    const uint64_t known = displaced ? std::max(noted_, full_number(*displaced, last())) : noted_;
    settled = published.exact && published.number <= known;
    if (settled) {
      count_missing(published.sequence);
      release(
        published
          .number);  // what was counted as lost may not be found by a later look at the topic DSM
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
