// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// A copy of a subscription's header, for processes that follow the reference in its registry entry
/// without the registry lock: a block freed meanwhile does no harm. The copy counts if the entry
/// still holds afterwards (see EntryCopy).
class SubscriptionCopy {
public:
  /// False if the header cannot be read.
  bool take(const Cluster & cluster, uint64_t offset) noexcept;
  const SubscriptionHeader & operator*() const noexcept {
    return *reinterpret_cast<const SubscriptionHeader *>(bytes_);
  }

private:
  SubscriptionHeader & header() noexcept { return *reinterpret_cast<SubscriptionHeader *>(bytes_); }

  alignas(SubscriptionHeader) std::byte bytes_[sizeof(SubscriptionHeader)]{};
};

}  // namespace manycore
