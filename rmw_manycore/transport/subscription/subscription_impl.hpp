// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "transport/registry/membership.hpp"
#include "transport/subscription/record_finder.hpp"
#include "transport/subscription/subscription.hpp"

namespace manycore {

struct Subscription::Impl {
  Impl(Registry & registry_, uint32_t slot_)
  : registry(registry_),
    slot(slot_),
    entry(registry_.endpoints()[slot_]),
    membership(registry_, entry.slot),
    cluster(registry_.clusters().at(entry.cluster)),
    header(*cluster.find<SubscriptionHeader>(entry.block.offset())),
    counts(entry, header),
    finder(registry_, cluster, header, entry, counts) {}

  void trace_claim(const RecordInfo & info, uint64_t number) noexcept;
  /// A finished topic DSM may have waited for this reader only: frees it.
  void sweep(uint32_t publisher) noexcept;

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Membership membership;
  Cluster & cluster;
  SubscriptionHeader & header;
  std::mutex mutex;  ///< held while a claim lives
  ReceptionCounts counts;
  RecordFinder finder;
};

}  // namespace manycore
