// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/detaching.hpp"

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
#include "transport/transfer/landing.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore {
namespace {

bool has_reader_in(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) {
  bool found = false;
  visit_reader_table(cluster, dsm, [&](const ReaderEntry & entry, uint32_t) {
    found = entry.active.load(std::memory_order_acquire) != 0 &&
            SegmentRef{entry.subscription.load()}.cluster() == receiver;
    return found;
  });
  return found;
}

}  // namespace

void detach_reader(Registry & registry, SourceEntry & source) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  auto * const reader =
    dsm == nullptr ? nullptr : registry.map<ReaderEntry>(SegmentRef{source.reader.load()});
  if (reader == nullptr) {
    return;
  }
  if (registry.map<SourceEntry>(SegmentRef{reader->source.load()}) != &source) {
    return;  // the entry belongs to another source by now
  }
  const Cluster & cluster = registry.clusters().at(SegmentRef{source.reader.load()}.cluster());
  const uint32_t receiver = SegmentRef{reader->subscription.load()}.cluster();
  free_reader_entry(cluster, *dsm, *reader);
  if (landing_table(cluster, *dsm) != nullptr && !has_reader_in(cluster, *dsm, receiver)) {
    landings::retire(cluster, *dsm, receiver);
  }
  dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
  notify_waiting_publisher(*dsm);  // it need not wait for this reader any more
}

}  // namespace manycore
