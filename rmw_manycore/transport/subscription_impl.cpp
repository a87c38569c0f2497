// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription_impl.hpp"

#include <algorithm>
#include <utility>

#include "transport/matching/closing.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore {
namespace {

uint32_t log2_at_least(uint32_t x) {
  uint32_t log2 = 0;
  while ((uint64_t{1} << log2) < x) {
    ++log2;
  }
  return log2;
}

bool displaces(const EndpointEntry & entry) { return entry.qos.history == History::keep_last; }

}  // namespace

SubscriptionHeader & Subscription::Impl::create(Registry & registry, uint32_t endpoint_slot) {
  EndpointEntry & entry = registry.endpoints()[endpoint_slot];
  Cluster & cluster = registry.clusters().at(entry.cluster);
  const uint32_t depth = displaces(entry) ? entry.qos.depth : keep_all_capacity;
  const uint32_t log2 = log2_at_least(depth);
  auto & header = cluster.allocate_cleared<SubscriptionHeader>(
    sizeof(SubscriptionHeader) + (uint64_t{8} << log2));
  header.endpoint.store(endpoint_slot);
  header.incarnation.store(entry.slot.incarnation);
  header.process.store(entry.process);
  header.depth = depth;
  header.slot_count_log2 = log2;
  header.keep_all = displaces(entry) ? 0 : 1;
  header.has_deadline = entry.qos.deadline_ns == infinite_ns ? 0 : 1;
  header.deadline_ns = entry.qos.deadline_ns;
  header.deadline.reset();
  subscriber_queue::initialize(header);
  header.magic.store(subscription_magic, std::memory_order_release);
  return header;
}

Subscription::Impl::Impl(Registry & registry_, uint32_t slot_)
: registry(registry_),
  slot(slot_),
  entry(registry_.endpoints()[slot_]),
  membership(registry_, entry.slot),
  cluster(registry_.clusters().at(entry.cluster)),
  header(*cluster.find<SubscriptionHeader>(entry.block.offset())) {}

bool Subscription::Impl::renew_readers() {
  const uint64_t generation = header.source_generation.load(std::memory_order_acquire);
  if (generation == seen_source_generation) {
    return false;
  }
  seen_source_generation = generation;
  bool has_new = false;
  std::vector<TopicDsmReader> renewed;
  visit_source_table(cluster, header, [&](SourceEntry & source, uint32_t index) {
    if (source.state.load(std::memory_order_acquire) != SourceState::active) {
      return false;
    }
    const auto known = std::find_if(
      readers.begin(), readers.end(),
      [&](const TopicDsmReader & reader) { return reader.is_same_source(source); });
    TopicDsmReader reader =
      known != readers.end() ? *known : TopicDsmReader(registry, source, index, entry);
    if (reader) {
      has_new = has_new || known == readers.end();
      renewed.push_back(reader);
    }
    return false;
  });
  readers = std::move(renewed);
  return has_new;
}

TopicDsmReader * Subscription::Impl::find_reader(uint32_t source, uint32_t incarnation) {
  for (TopicDsmReader & reader : readers) {
    if (
      reader.index() == source &&
      (reader.incarnation() & Hint::incarnation_mask) == (incarnation & Hint::incarnation_mask)) {
      return &reader;
    }
  }
  return nullptr;
}

/// Hints may be missing: forget those that are there and look into every topic DSM instead.
void Subscription::Impl::resync(std::optional<Hint> popped) {
  renew_readers();
  announced.clear();
  for (; popped || (popped = subscriber_queue::pop(header)); popped.reset()) {
    if (const std::optional<Candidate> candidate = candidate_of(*popped)) {
      announced.emplace_back(candidate->reader->index(), candidate->number);
    }
  }
  std::sort(announced.begin(), announced.end());
  announced.erase(std::unique(announced.begin(), announced.end()), announced.end());
  scratch.clear();
  for (TopicDsmReader & reader : readers) {
    reader.list_waiting(scratch);
  }
  std::stable_sort(scratch.begin(), scratch.end(), [](const auto & a, const auto & b) {
    return a.source_timestamp_ns < b.source_timestamp_ns;
  });
  backlog.insert(backlog.end(), scratch.begin(), scratch.end());
  // Stale hints do not make up for others: who was told of them finds fewer messages, never more.
  const auto unannounced = std::count_if(scratch.begin(), scratch.end(), [&](const auto & waiting) {
    return !std::binary_search(
      announced.begin(), announced.end(), std::pair(waiting.source, waiting.number));
  });
  const auto found_of_announced = static_cast<ptrdiff_t>(scratch.size()) - unannounced;
  count_lost_replies(announced.size() - static_cast<size_t>(found_of_announced));
  unsettled = true;
  if (unannounced > 0) {
    arrivals_by_resync.fetch_add(static_cast<uint64_t>(unannounced), std::memory_order_relaxed);
    header.note_arrival();
  }
  while (displaces(entry) && backlog.size() > header.depth) {
    const TopicDsmReader::Waiting oldest = backlog.front();
    backlog.pop_front();
    if (TopicDsmReader * const reader = find_reader(oldest.source, oldest.incarnation)) {
      reader->skip(oldest.number);
    }
    count_lost_replies(1);
  }
  backlog_size.store(backlog.size(), std::memory_order_release);
  if (!backlog.empty()) {
    // Who looked while the hints were gone and the backlog was not there yet may be about to sleep.
    notify_process(registry, entry.process);
  }
}

void Subscription::Impl::resync_if_asked() {
  if (
    header.resync.load(std::memory_order_relaxed) != 0 &&
    header.resync.exchange(0, std::memory_order_seq_cst) != 0) {
    resync();
  }
}

std::optional<Subscription::Impl::Candidate> Subscription::Impl::next_of_backlog() {
  while (!backlog.empty()) {
    const TopicDsmReader::Waiting waiting = backlog.front();
    backlog.pop_front();
    backlog_size.store(backlog.size(), std::memory_order_relaxed);
    TopicDsmReader * const reader = find_reader(waiting.source, waiting.incarnation);
    if (reader != nullptr && waiting.number > reader->taken()) {
      return Candidate{reader, waiting.number};
    }
  }
  return std::nullopt;
}

std::optional<Subscription::Impl::Candidate> Subscription::Impl::candidate_of(const Hint & hint) {
  TopicDsmReader * const reader = find_reader(hint.source, hint.source_incarnation);
  if (reader == nullptr) {
    return std::nullopt;  // its topic DSM is gone
  }
  const uint64_t number = reader->full_number(hint.number);
  if (number <= reader->noted() || number > reader->last() || reader->is_given_up(number)) {
    return std::nullopt;  // a double, or not of this source
  }
  return Candidate{reader, number};
}

std::optional<Subscription::Impl::Candidate> Subscription::Impl::next() {
  while (true) {
    resync_if_asked();
    if (
      displaces(entry) && !backlog.empty() &&
      backlog.size() + subscriber_queue::size(header) > header.depth) {
      resync();  // newer messages displace those of the backlog
    }
    if (const std::optional<Candidate> candidate = next_of_backlog()) {
      return candidate;
    }
    const std::optional<Hint> hint = subscriber_queue::pop(header);
    if (!hint) {
      settle();
      return std::nullopt;
    }
    if (renew_readers()) {
      // A hint of a new source may overtake the matcher's resync, and with it the source's history.
      // Looking into all sources finds what the hint announced as well.
      resync(hint);
    } else if (const std::optional<Candidate> candidate = candidate_of(*hint)) {
      return candidate;
    }
  }
}

void Subscription::Impl::settle() noexcept {
  if (entry.role == EndpointRole::reply) {
    return;
  }
  const uint64_t dropped = header.dropped.load(std::memory_order_relaxed);
  if (!unsettled && dropped == settled_dropped) {
    return;
  }
  bool all = true;
  for (TopicDsmReader & reader : readers) {
    all = reader.settle() && all;
  }
  if (all) {
    unsettled = false;
    settled_dropped = dropped;
    header.lost_beside_dropped.store(
      entry.counters.lost.load(std::memory_order_relaxed) - dropped, std::memory_order_relaxed);
  }
}

void Subscription::Impl::sweep() noexcept {
  try {
    const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
    closing::sweep(registry);
  } catch (const std::exception &) {
    // Somebody holds the registry, and a take does not wait for him: the next change of the graph
    // sweeps.
  }
}

void Subscription::Impl::count_lost_replies(uint64_t count) noexcept {
  if (entry.role == EndpointRole::reply && count != 0) {
    count_lost(count);
  }
}

/// In both of the words of which lost_so_far() takes the larger.
void Subscription::Impl::count_lost(uint64_t count) noexcept {
  entry.counters.lost.fetch_add(count, std::memory_order_relaxed);
  header.lost_beside_dropped.fetch_add(count, std::memory_order_relaxed);
}

void Subscription::Impl::count_taken(uint64_t bytes) noexcept {
  EndpointCounters & counters = entry.counters;
  counters.messages.store(received, std::memory_order_relaxed);
  counters.bytes.store(
    counters.bytes.load(std::memory_order_relaxed) + bytes, std::memory_order_relaxed);
}

void Subscription::Impl::count_rejected(uint64_t bytes) noexcept {
  --received;
  count_taken(-bytes);
  count_lost(1);
  notify_event_watchers(registry, entry.process);
}

}  // namespace manycore
