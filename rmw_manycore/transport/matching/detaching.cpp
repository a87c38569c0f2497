// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/detaching.hpp"

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {

namespace {

bool has_reader_in(uint32_t receiver, const Cluster & cluster, TopicDsmHeader & dsm) {
  bool found = false;
  visit_reader_table(cluster, dsm, [&](const ReaderEntry & reader, uint32_t) {
    const SegmentRef subscription{reader.subscription.load()};
    found = reader.active.load() != 0 && subscription.cluster() == receiver;
    return found;
  });
  return found;
}

}  // namespace

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
    free_reader_entry(cluster, *dsm, *reader);
    dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
    notify_waiting_publisher(*dsm);  // it need not wait for this reader any more
  }
  transfer::retire_unless(
    cluster, *dsm, receiver, [&] { return has_reader_in(receiver, cluster, *dsm); });
}

}  // namespace manycore
