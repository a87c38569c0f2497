// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/reader_list.hpp"

#include <algorithm>

#include "transport/reader_table.hpp"

namespace manycore {

/// Acquire, as in ReceiveThread::push_to_readers(): who reads a value of a later reader finds the generation raised.
bool ReaderList::resolve(ReaderEntry & entry, Reader & reader) {
  reader.endpoint = entry.endpoint.load(std::memory_order_acquire);
  const SegmentRef subscription{entry.subscription.load(std::memory_order_acquire)};
  reader.cluster = subscription.cluster();
  reader.subscription = registry_.clusters().find<SubscriptionHeader>(subscription);
  reader.source = registry_.clusters().find<SourceEntry>(
    SegmentRef{entry.source.load(std::memory_order_acquire)});
  reader.source_index = entry.source_index.load(std::memory_order_acquire);
  reader.source_incarnation = entry.source_incarnation.load(std::memory_order_acquire);
  if (
    reader.subscription == nullptr || reader.source == nullptr ||
    reader.endpoint >= registry_.endpoints().high_water()) {
    return false;
  }
  const EndpointEntry & endpoint = registry_.endpoints()[reader.endpoint];
  if (endpoint.process >= registry_.processes().high_water()) {
    return false;
  }
  reader.wake = &registry_.processes()[endpoint.process].wake;
  reader.reliable = endpoint.qos.reliability == Reliability::reliable;
  reader.gid = endpoint.gid;
  return true;
}

void ReaderList::rebuild() {
  do {
    seen_ = dsm_.match_generation.load(std::memory_order_seq_cst);
    readers_.clear();
    for_each_reader(cluster_, dsm_, [&](ReaderEntry & entry) {
      Reader reader;
      if (resolve(entry, reader)) {
        readers_.push_back(reader);
      }
    });
  } while (dsm_.match_generation.load(std::memory_order_seq_cst) != seen_);
  // Readers of one process stand together, so that it is woken once.
  std::sort(readers_.begin(), readers_.end(), [](const Reader & a, const Reader & b) {
    return a.wake < b.wake;
  });
}

}  // namespace manycore
