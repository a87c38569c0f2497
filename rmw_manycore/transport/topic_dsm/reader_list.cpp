// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/reader_list.hpp"

#include <algorithm>
#include <numeric>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore {
namespace {

constexpr uint64_t no_match_generation = UINT64_MAX;  ///< matches no `match_generation`

}  // namespace

/// Acquire, as in ReceiveThread::push_to_readers(): a process that reads a field of the entry's
/// next reader also finds `match_generation` incremented.
Reader ReaderList::resolve(ReaderEntry & entry) {
  Reader reader;
  reader.endpoint = entry.endpoint.load(std::memory_order_acquire);
  const SegmentRef subscription{entry.subscription.load(std::memory_order_acquire)};
  const SegmentRef source{entry.source.load(std::memory_order_acquire)};
  reader.cluster = subscription.cluster();
  const Cluster & cluster = registry_.clusters().at(reader.cluster);
  reader.subscription = cluster.find<SubscriptionHeader>(subscription.offset());
  reader.source = registry_.clusters().at(source.cluster()).find<SourceEntry>(source.offset());
  reader.source_index = entry.source_index.load(std::memory_order_acquire);
  reader.source_incarnation = entry.source_incarnation.load(std::memory_order_acquire);
  if (
    reader.subscription == nullptr || reader.source == nullptr ||
    reader.endpoint >= registry_.endpoints().high_water() ||
    registry_.endpoints()[reader.endpoint].process >= registry_.processes().high_water()) {
    throw Error(
      ErrorCode::corrupt, "cluster " + std::to_string(cluster_.id()) +
                            " is damaged; stop the platform's nodes and run 'manycore clean'");
  }
  const EndpointEntry & endpoint = registry_.endpoints()[reader.endpoint];
  reader.wake = &registry_.processes()[endpoint.process].wake;
  reader.reliable = endpoint.qos.reliability == Reliability::reliable;
  reader.gid = endpoint.gid;
  return reader;
}

void ReaderList::throw_failure(const std::string & topic) const {
  try {
    std::rethrow_exception(failure_);
  } catch (const Error & error) {
    throw Error(
      error.code(),
      "cannot publish on '" + topic + "': cannot reach a subscription: " + error.what());
  }
}

void ReaderList::add(ReaderEntry & entry, uint32_t index) {
  try {
    next_.push_back(resolve(entry));
    next_.back().index = index;
  } catch (const Error &) {
    failure_ = std::current_exception();
  }
}

void ReaderList::copy_table() {
  do {
    seen_ = dsm_.match_generation.load(std::memory_order_seq_cst);
    next_.clear();
    failure_ = nullptr;
    visit_reader_table(cluster_, dsm_, [&](ReaderEntry & entry, uint32_t index) {
      if (entry.active.load(std::memory_order_acquire) != 0) {
        add(entry, index);
      }
      return false;
    });
  } while (!is_current());
  // Group readers by process, so that each process is woken once.
  std::sort(
    next_.begin(), next_.end(), [](const Reader & a, const Reader & b) { return a.wake < b.wake; });
  next_by_gid_.resize(next_.size());
  std::iota(next_by_gid_.begin(), next_by_gid_.end(), 0);
  std::sort(next_by_gid_.begin(), next_by_gid_.end(), [this](uint32_t a, uint32_t b) {
    return next_[a].gid < next_[b].gid;
  });
}

bool ReaderList::rebuild() noexcept {
  bool is_copied = true;
  try {
    copy_table();
    readers_.swap(next_);
    by_gid_.swap(next_by_gid_);
  } catch (...) {
    failure_ = std::current_exception();
    is_copied = false;
  }
  if (failure_) {
    seen_ = no_match_generation;
  }
  return is_copied;
}

void ReaderList::request_resyncs() const noexcept {
  for_each_reader(cluster_, dsm_, [&](ReaderEntry & entry) {
    const SegmentRef ref{entry.subscription.load(std::memory_order_acquire)};
    auto * const header = registry_.clusters().find<SubscriptionHeader>(ref);
    if (header != nullptr && header->magic.load() == subscription_magic) {
      header->resync.store(1, std::memory_order_seq_cst);
      notify_watchers(registry_, *header);
    }
  });
}

Readers ReaderList::with_gid(const Gid & gid) const noexcept {
  const auto found = std::lower_bound(
    by_gid_.begin(), by_gid_.end(), gid,
    [this](uint32_t index, const Gid & wanted) { return readers_[index].gid < wanted; });
  const bool is_there = found != by_gid_.end() && readers_[*found].gid == gid;
  return is_there ? Readers(&readers_[*found], 1) : Readers(nullptr, 0);
}

}  // namespace manycore
