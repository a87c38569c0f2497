// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/handover_mutex.hpp"
#include "transport/peers/matches.hpp"
#include "transport/registry/membership.hpp"
#include "transport/subscription/hold.hpp"
#include "transport/subscription/record_finder.hpp"
#include "transport/subscription/subscription.hpp"

namespace manycore {

/// State of a subscription in its process; shared state is in the endpoint entry and the header.
struct Subscription::Impl {
  Impl(Registry & registry_, uint32_t slot_)
  : registry(registry_),
    slot(slot_),
    entry(registry_.endpoints()[slot_]),
    membership(registry_, entry.slot),
    cluster(registry_.clusters().at(entry.cluster)),
    header(*cluster.find<SubscriptionHeader>(entry.block.offset())),
    counts(entry, header),
    finder(registry_, cluster, header, entry, counts),
    matches(registry_, entry) {}

  void trace_claim(const RecordInfo & info, uint64_t number, uint64_t publisher) noexcept;
  /// Called after each message. An executor takes only what is there, so it may never find out by a
  /// take that nothing is left.
  void settle_after_last() noexcept;
  /// Frees a finished topic DSM if it was waiting for this reader only.
  void sweep(uint32_t publisher) noexcept;

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Membership membership;
  Cluster & cluster;
  SubscriptionHeader & header;
  HeldCount holds;
  HandoverMutex mutex;  ///< held during the lifetime of a Claim
  ReceptionCounts counts;
  RecordFinder finder;
  Matches matches;
};

}  // namespace manycore
