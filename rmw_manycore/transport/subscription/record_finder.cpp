// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/record_finder.hpp"

#include <algorithm>
#include <new>

#include "transport/registry/endpoint_blocks.hpp"

namespace manycore {

RecordFinder::RecordFinder(
  Registry & registry, Cluster & cluster, SubscriptionHeader & header, EndpointEntry & entry,
  ReceptionCounts & counts) noexcept
: registry_(registry),
  cluster_(cluster),
  header_(header),
  counts_(counts),
  sources_(registry, header, entry) {}

bool RecordFinder::has_records() const noexcept {
  return !subscriber_queue::empty(header_) || backlog_.size() != 0 || has_to_resync();
}

bool RecordFinder::has_to_resync() const noexcept {
  return header_.resync.load(std::memory_order_seq_cst) != 0;
}

uint64_t RecordFinder::waiting() const noexcept {
  return subscriber_queue::size(header_) + backlog_.size();
}

uint64_t RecordFinder::arrivals() const noexcept {
  const uint64_t pushed =
    header_.tail.load(std::memory_order_seq_cst) - (uint64_t{1} << header_.slot_count_log2);
  return pushed + arrivals_by_resync_.load(std::memory_order_relaxed);
}

/// Where memory runs out, the next attempt finds what this one has not. Other threads may have seen
/// the queue drained.
template<typename Act>
auto RecordFinder::resync_later_if_it_lacks_memory(const Act & act) {
  try {
    return act();
  } catch (const std::bad_alloc &) {
    header_.resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry_, header_);
    cluster_.wake_reaper();  // some sources may be finished
    throw;
  }
}

std::optional<RecordFinder::Candidate> RecordFinder::next() {
  return resync_later_if_it_lacks_memory([this] { return find_next(); });
}

void RecordFinder::resync_if_asked() {
  if (take_request_to_resync()) {
    resync_later_if_it_lacks_memory([this] { resync(); });
  }
}

std::optional<RecordFinder::Candidate> RecordFinder::find_next() {
  while (true) {
    if (take_request_to_resync()) {
      resync();
    }
    if (header_.keep_all == 0 && !backlog_.empty() && waiting() > header_.depth) {
      resync();  // newer messages displace those in the backlog
    }
    if (const std::optional<Candidate> candidate = next_of_backlog()) {
      return candidate;
    }
    const std::optional<Hint> hint = subscriber_queue::pop(header_);
    if (!hint) {
      settle();
      return std::nullopt;
    }
    // A resync scans all sources, so it finds this hint's record too. If earlier hints are missing,
    // `resync` was set before this hint was pushed, but possibly after the check above; or is set
    // for a source that could not be mapped before.
    Source * const source = sources_.find(*hint);
    if (take_request_to_resync()) {
      resync(hint);
    } else if (source != nullptr) {
      return Candidate{source, {hint->number, true}};
    }
  }
}

std::optional<RecordFinder::Candidate> RecordFinder::next_of_backlog() {
  while (!backlog_.empty()) {
    const Source::Waiting oldest = backlog_.oldest();
    Source * const source = sources_.find(Hint{oldest.publisher, oldest.incarnation, 0});
    backlog_.pop_oldest();
    if (source != nullptr && oldest.number > source->taken()) {
      return Candidate{source, {oldest.number, false}};
    }
  }
  return std::nullopt;
}

bool RecordFinder::take_request_to_resync() noexcept {
  return header_.resync.load(std::memory_order_relaxed) != 0 &&
         header_.resync.exchange(0, std::memory_order_seq_cst) != 0;
}

/// Hints may be missing: discards the queued ones and scans all topic DSMs instead. The sources are
/// renewed after that: a hint that was discarded may be the first one of its publisher. Where
/// memory runs out, what was drained and found is kept for the next resync.
void RecordFinder::resync(std::optional<Hint> popped) {
  drain_queue(popped);
  sources_.renew();
  bool some_finished = false;
  for (Source & source : sources_) {
    some_finished = source.list_waiting(found_) || some_finished;
  }
  std::stable_sort(found_.begin(), found_.end(), [](const auto & a, const auto & b) {
    return a.source_timestamp_ns < b.source_timestamp_ns;
  });
  backlog_.append(found_);
  // Count only records that no hint announced. Stale hints are not subtracted: a listener notified
  // of them finds fewer messages than arrivals, never more.
  const uint64_t announced = count_announced(found_);
  counts_.suspect_losses();
  const uint64_t unannounced = found_.size() - announced;
  found_.clear();
  announced_.clear();
  if (unannounced != 0) {
    arrivals_by_resync_.fetch_add(unannounced, std::memory_order_relaxed);
    if (header_.note_arrival()) {  // a deadline just started
      notify_event_watchers(registry_, header_.process.load(std::memory_order_relaxed));
    }
  }
  if (drop_beyond_depth() || some_finished) {
    cluster_.wake_reaper();  // to free topic DSMs
  }
  if (!backlog_.empty()) {
    // A thread that checked after the hints were drained and before the backlog was filled may be
    // about to sleep.
    notify_watchers(registry_, header_);
  }
}

/// Each hint has its place before it leaves the queue.
void RecordFinder::drain_queue(std::optional<Hint> popped) {
  announced_.emplace_back();
  for (; popped || (popped = subscriber_queue::pop(header_)); popped.reset()) {
    announced_.back() = popped->word();
    announced_.emplace_back();
  }
  announced_.pop_back();
  std::sort(announced_.begin(), announced_.end());
  announced_.erase(std::unique(announced_.begin(), announced_.end()), announced_.end());
}

/// Number of these records that the drained hints announced.
uint64_t RecordFinder::count_announced(const std::vector<Source::Waiting> & found) const {
  return static_cast<uint64_t>(
    std::count_if(found.begin(), found.end(), [&](const Source::Waiting & waiting) {
      const Hint hint{waiting.publisher, waiting.incarnation, waiting.number};
      return std::binary_search(announced_.begin(), announced_.end(), hint.word());
    }));
}

/// True if topic DSMs of gone publishers may have been waiting for what is dropped.
bool RecordFinder::drop_beyond_depth() {
  bool some_finished = false;
  while (header_.keep_all == 0 && backlog_.size() > header_.depth) {
    const Source::Waiting oldest = backlog_.oldest();
    if (Source * const source = sources_.find(Hint{oldest.publisher, oldest.incarnation, 0})) {
      some_finished = source->skip(oldest.number) || some_finished;
    }
    backlog_.pop_oldest();
  }
  return some_finished;
}

void RecordFinder::settle() noexcept {
  if (!counts_.needs_settling()) {
    return;
  }
  sources_.try_to_renew();  // one that is gone has nothing to settle
  // Load before the sources are checked: later displacements count next time.
  const uint64_t displaced = header_.displaced().hints;
  bool all = true;
  bool some_finished = false;
  for (Source & source : sources_) {
    const Source::Settled settled = source.settle();
    all = all && settled != Source::Settled::no;
    some_finished = some_finished || settled == Source::Settled::finished;
  }
  if (all) {
    counts_.note_settled(displaced);
  }
  if (some_finished) {
    cluster_.wake_reaper();  // to free topic DSMs
  }
}

}  // namespace manycore
