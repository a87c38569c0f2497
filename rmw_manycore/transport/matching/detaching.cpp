// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/detaching.hpp"

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore {

void detach_reader(Registry & registry, SourceEntry & source) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  auto * const reader =
    dsm == nullptr ? nullptr : registry.reach<ReaderEntry>(SegmentRef{source.reader.load()});
  if (reader == nullptr) {
    return;
  }
  if (registry.reach<SourceEntry>(SegmentRef{reader->source.load()}) != &source) {
    return;  // another's by now
  }
  free_reader_entry(
    registry.clusters().at(SegmentRef{source.reader.load()}.cluster()), *dsm, *reader);
  dsm->match_generation.fetch_add(1, std::memory_order_seq_cst);
  dsm->progress.fetch_add(1, std::memory_order_seq_cst);
  futex_wake_all(dsm->progress);  // a publisher that waited for this reader need not
}

}  // namespace manycore
