// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/source.hpp"

#include <algorithm>

#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/chunk_table.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
#include "virtual_time/door.hpp"

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

Source::Source(
  Registry & registry, const Peer & publisher, SubscriptionHeader & header,
  EndpointEntry & subscription)
: row_(&registry.endpoints()[publisher.slot]),
  slot_(publisher.slot),
  incarnation_(publisher.incarnation),
  reader_(endpoint_word(header.endpoint.load(), header.incarnation.load())),
  reads_history_(
    publisher.durability == Durability::transient_local &&
    subscription.qos.durability == Durability::transient_local &&
    subscription.role != EndpointRole::reply),
  header_(&header),
  subscription_(&subscription) {
  cluster_ = registry.clusters().find(publisher.block.cluster());
  own_cluster_ = registry.clusters().find(subscription.cluster);
  dsm_ = registry.clusters().find<TopicDsmHeader>(publisher.block);
}

/// Dekker with reclaim() and with the process that frees: `reading` is stored before `number`, and
/// before the row is loaded, all seq_cst. So either the publisher sees the claim and leaves the
/// bytes alone, or this reader sees that the number is gone.
bool Source::begin_look(uint64_t word) noexcept {
  header_->reading.store(word, std::memory_order_seq_cst);
  return may_look();
}

/// seq_cst: the process that frees stores the row's state before it loads `reading`.
bool Source::end_look() noexcept {
  header_->reading.store(Reading::nothing, std::memory_order_seq_cst);
  return row_->slot.state.load(std::memory_order_seq_cst) == SlotState::freeing && is_current();
}

bool Source::may_look() const noexcept {
  return has_memory(row_->slot.state.load(std::memory_order_seq_cst)) &&
         row_->slot.incarnation.load(std::memory_order_seq_cst) == incarnation_;
}

/// The seat stays this reader's while the subscription's row is live. Of the history, records may
/// be taken or noted before there is a seat.
void Source::meet() noexcept {
  if (seat_ != nullptr) {
    return;
  }
  seat_ = find_seat(*cluster_, *dsm_, reader_);
  if (seat_ == nullptr) {
    return;
  }
  const uint64_t start = seat_->taken.load(std::memory_order_relaxed);
  if (taken_ > start) {
    seat_->taken.store(taken_, std::memory_order_seq_cst);
  }
  taken_ = std::max(taken_, start);
  noted_ = std::max(noted_, start);
}

LastPublished Source::last_published() const noexcept {
  return seat_ != nullptr ? last_published_for(*dsm_, *seat_) : manycore::last_published(*dsm_);
}

uint64_t Source::number_of(const Wanted & wanted) const noexcept {
  if (!wanted.is_from_hint) {
    return wanted.number;
  }
  const uint64_t latest = last();  // load once: it increases concurrently
  const uint64_t number = Hint::full_number(wanted.number, latest);
  return number <= latest ? number : no_record;
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
  return lifespan_ns != infinite_ns && stamp_now_ns() - record.source_timestamp_ns > lifespan_ns;
}

/// A server counts the replies to all clients, so more than a period of them may follow one whose
/// hint still waits, and its low bits then name another record. A look at all finds it.
bool Source::is_misnamed(const Wanted & wanted, ClaimResult result) const noexcept {
  return wanted.is_from_hint && subscription_->role == EndpointRole::reply &&
         (result == ClaimResult::gone || result == ClaimResult::not_ours);
}

Source::Claimed Source::claim(const Wanted & wanted, View & view) noexcept {
  if (!begin_look(Reading::of(hint_of(wanted.number)))) {
    return {ClaimResult::not_ours, end_look()};
  }
  meet();
  const uint64_t number = number_of(wanted);
  const bool is_stale = number == no_record || (wanted.is_from_hint && number <= noted_);
  if (is_stale || !may_take()) {
    return {ClaimResult::not_ours, end_look()};
  }
  const ClaimResult result = look_at(number, view);
  view.number = number;
  if (is_misnamed(wanted, result)) {
    header_->resync.store(1, std::memory_order_seq_cst);
    return {ClaimResult::not_ours, end_look()};
  }
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
  count_gap(record.publication_sequence_number);
  if (is_expired(record)) {
    return ClaimResult::expired;
  }
  view.record = &record;
  view.data = data;
  const RecordMemory memory = record.memory.load(std::memory_order_acquire);
  view.chunk = memory == RecordMemory::ring ? nullptr : chunk_head(*cluster_, record.offset);
  view.is_for_one_reader = memory == RecordMemory::chunk_of_one_reader;
  return ClaimResult::claimed;
}

/// The publisher waits for `taken` only, so it is notified before the look ends. `taken` is stored
/// seq_cst: the publisher sets `writer_waits` before it loads `taken` again.
bool Source::note_taken(uint64_t number) noexcept {
  taken_ = std::max(taken_, number);
  noted_ = std::max(noted_, number);
  meet();
  if (seat_ != nullptr && number > seat_->taken.load(std::memory_order_relaxed)) {
    seat_->taken.store(number, std::memory_order_seq_cst);
  }
  notify_waiting_publisher(*dsm_);
  const bool finished = is_finished();
  if (finished) {
    const LastPublished published = last_published();
    if (published.exact) {
      count_lost(published.sequence);
    }
  }
  return finished;
}

bool Source::release(uint64_t number) noexcept {
  const bool is_finished = note_taken(number);
  return end_look() || is_finished;
}

bool Source::skip(uint64_t number) noexcept {
  return begin_look(Reading::header_only(slot_, incarnation_)) ? release(number) : end_look();
}

uint64_t Source::last() const noexcept {
  if (subscription_->role == EndpointRole::reply) {
    return seat_ != nullptr ? seat_->last_reply.load(std::memory_order_seq_cst) : no_record;
  }
  return arrived().last();
}

/// Pins the generation, then one record after the other in it, so a reader that is stopped in a
/// scan costs at most what a claim costs: one record, and no younger generation. Dekker with
/// retire(), as in generation_of(): a generation that is still open in the second load is not freed
/// while `reading` names it or a record in it.
void Source::scan(
  const GenerationEntry & generation, const transfer::Arrived & arrived, uint64_t last,
  std::vector<Waiting> & out) {
  const uint64_t first = generation.first.load(std::memory_order_seq_cst);
  if (first == 0 || first > last) {
    return;
  }
  header_->reading.store(Reading::generation(hint_of(first)), std::memory_order_seq_cst);
  const bool is_open = generation.first.load(std::memory_order_seq_cst) == first;
  const Descriptors descriptors = is_open ? descriptors_of(generation) : Descriptors{};
  for (uint64_t i = 0; i < descriptors.count; ++i) {
    RecordDescriptor & record = descriptors.begin[i];
    const uint64_t number = record.number.load(std::memory_order_relaxed);
    if (number <= noted_ || number > last || !arrived.has(number)) {
      continue;
    }
    header_->reading.store(Reading::of(hint_of(number)), std::memory_order_seq_cst);
    if (record.number.load(std::memory_order_seq_cst) == number && is_for_us(record)) {
      out.push_back({record.source_timestamp_ns, number, slot_, incarnation_});
    }
  }
}

void Source::scan_all(std::vector<Waiting> & out) {
  meet();
  const uint64_t last = this->last();
  if (last > noted_ && may_take()) {
    for (const GenerationEntry & generation : dsm_->generations) {
      scan(generation, arrived(), last, out);
    }
    noted_ = last;
  }
}

bool Source::list_waiting(std::vector<Waiting> & out) {
  const auto own_part = static_cast<ptrdiff_t>(out.size());
  if (!begin_look(Reading::header_only(slot_, incarnation_))) {
    return end_look();
  }
  const bool was_finished = is_known_finished();
  if (reads_history_) {
    meet();  // the process that closed the publisher may have given the seat
  }
  // Most sources have no new record: a subscription resyncs for each publisher that leaves.
  if (dsm_->last.load(std::memory_order_seq_cst) > noted_) {
    try {
      scan_all(out);
    } catch (const std::bad_alloc &) {
      out.resize(static_cast<size_t>(own_part));  // none is noted: the next call lists them
      end_look();
      throw;
    }
  }
  order(out, own_part);
  const bool finished = is_finished() && !was_finished;
  return end_look() || finished;
}

void Source::count_lost(uint64_t last_sequence) noexcept {
  if (const uint64_t missing = account_for(last_sequence); missing != 0) {
    subscription_->counters.lost.fetch_add(missing, std::memory_order_relaxed);
  }
}

/// What a KEEP_LAST 1 subscription did not take is not lost where it finds a newer message.
void Source::count_gap(uint64_t found_sequence) noexcept {
  const uint64_t counted = account_for(found_sequence);
  if (counted > 1) {  // one is the message that was found
    EndpointCounters & counters = subscription_->counters;
    (keeps_newest_only(*subscription_) ? counters.superseded : counters.lost)
      .fetch_add(counted - 1, std::memory_order_relaxed);
  }
}

/// Without a seat the history is read, whose losses are not counted.
uint64_t Source::account_for(uint64_t last_sequence) noexcept {
  const uint64_t before =
    seat_ == nullptr ? UINT64_MAX : seat_->accounted.load(std::memory_order_relaxed);
  if (last_sequence <= before) {
    return 0;
  }
  seat_->accounted.store(last_sequence, std::memory_order_relaxed);
  return last_sequence - before;
}

/// True if the hints of all records published before this call have been pushed and popped, or
/// displaced. A publisher pushes to its own cluster inside its phase, and no hint is left; nor is
/// one missing that it could not push.
bool Source::has_announced_all() const noexcept {
  return cluster_ == own_cluster_ && dsm_->phase.load(std::memory_order_seq_cst) % 2 == 0 &&
         header_->resync.load(std::memory_order_seq_cst) == 0 && subscriber_queue::empty(*header_);
}

Source::Settled Source::settle() noexcept {
  if (!begin_look(Reading::header_only(slot_, incarnation_))) {
    return end_look() ? Settled::finished : Settled::yes;  // the process that frees counts
  }
  const bool was_finished = is_known_finished();
  meet();
  if (seat_ == nullptr) {
    const bool is_waited_for = end_look();
    return is_waited_for ? Settled::finished : Settled::yes;
  }
  // Load first: outside the phase, the last message is not gone for one that will supersede it.
  const bool may_be_replaced =
    keeps_newest_only(*subscription_) && dsm_->phase.load(std::memory_order_seq_cst) % 2 != 0;
  const LastPublished published = last_published();
  const bool is_due = seat_->accounted.load(std::memory_order_relaxed) < published.sequence;
  const uint64_t known = has_announced_all() ? published.number : noted_;
  const bool is_settled = published.exact && !(is_due && may_be_replaced) &&
                          arrived().is_settled(published.number, known);
  bool is_over = false;
  if (is_settled) {
    count_lost(published.sequence);
    is_over = note_taken(published.number) && !was_finished;
  }
  is_over = end_look() || is_over;
  return is_over ? Settled::finished : is_settled ? Settled::yes : Settled::no;
}

/// A reader of the history without a seat has not stored what it has taken.
bool Source::is_known_finished() const noexcept {
  return is_finished() && (seat_ != nullptr || !reads_history_);
}

/// The history of a closed publisher is for readers that were there: they were given seats.
bool Source::may_take() const noexcept {
  return seat_ != nullptr ||
         (reads_history_ && row_->slot.state.load(std::memory_order_acquire) == SlotState::live);
}

/// What is owed is what the process that frees looks at.
bool Source::is_finished() const noexcept {
  return row_->slot.state.load(std::memory_order_acquire) != SlotState::live &&
         (seat_ == nullptr || owed_to(*dsm_, *seat_) == 0);
}

}  // namespace manycore
