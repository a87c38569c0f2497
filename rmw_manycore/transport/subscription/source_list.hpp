// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "transport/registry/registry.hpp"
#include "transport/topic_dsm/source.hpp"

namespace manycore {

/// A subscription's copy of its source table. Used by one thread at a time (the subscription's
/// mutex).
class SourceList {
public:
  SourceList(
    Registry & registry, Cluster & cluster, SubscriptionHeader & header,
    EndpointEntry & entry) noexcept
  : registry_(registry), cluster_(cluster), header_(header), entry_(entry) {}

  /// Updates the copy if the table changed. True if there is a new source.
  bool renew();
  /// Nullptr if the source is gone.
  Source * find(uint32_t index, uint32_t incarnation) noexcept;

  std::vector<Source>::iterator begin() noexcept { return sources_.begin(); }
  std::vector<Source>::iterator end() noexcept { return sources_.end(); }

private:
  /// The first source at or after `from` whose index is at least `index`.
  std::vector<Source>::iterator at_or_after(
    std::vector<Source>::iterator from, uint32_t index) noexcept;

  Registry & registry_;
  Cluster & cluster_;
  SubscriptionHeader & header_;
  EndpointEntry & entry_;
  std::vector<Source> sources_;
  uint64_t seen_generation_ = 0;
};

}  // namespace manycore
