// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/detaching.hpp"

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore {

void remove_reader(const Cluster & cluster, TopicDsmHeader & dsm, ReaderEntry & reader) noexcept {
  if (reader.active.load() != 0) {  // else its match is half made, and not counted
    const SegmentRef subscription{reader.subscription.load()};
    landings::discount_reader(cluster, dsm, subscription.cluster());
  }
  free_reader_entry(cluster, dsm, reader);
}

void detach_reader(Registry & registry, SourceEntry & source, uint32_t receiver) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  if (dsm == nullptr) {
    return;
  }
  const Cluster & cluster = registry.clusters().at(SegmentRef{source.topic_dsm.load()}.cluster());
  auto * const reader = registry.map<ReaderEntry>(SegmentRef{source.reader.load()});
  // Else the entry belongs to another source by now, or was not filled in.
  if (
    reader != nullptr && registry.map<SourceEntry>(SegmentRef{reader->source.load()}) == &source) {
    remove_reader(cluster, *dsm, *reader);
    dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
    notify_waiting_publisher(*dsm);  // it need not wait for this reader any more
  }
  landings::retire_unread(cluster, *dsm, receiver);
}

}  // namespace manycore
