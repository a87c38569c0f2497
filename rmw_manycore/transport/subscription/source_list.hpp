// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/topic_dsm/source.hpp"

namespace manycore {

/// The topic DSMs from which a subscription may take: those of its publishers that are there, and
/// of closed ones that may hold messages for it. Used by one thread at a time (the subscription's
/// mutex).
class SourceList {
public:
  SourceList(Registry & registry, SubscriptionHeader & header, EndpointEntry & entry)
  : registry_(registry),
    header_(header),
    entry_(entry),
    publishers_(registry, entry, Peers::Of::with_memory) {}

  /// Updates the list if rows of the topic changed. Throws std::bad_alloc.
  void renew();
  void try_to_renew() noexcept;
  /// The source that a hint or a listed record names; looks at the rows if it is not known. Nullptr
  /// if its topic DSM is gone. Throws as renew() does.
  Source * find(const Hint & hint);

  std::vector<Source>::iterator begin() noexcept { return sources_.begin(); }
  std::vector<Source>::iterator end() noexcept { return sources_.end(); }

private:
  void rebuild();
  Source * find_known(const Hint & hint) noexcept;
  /// The first source whose slot is at least `slot`.
  std::vector<Source>::iterator at_or_after(uint32_t slot) noexcept;

  Registry & registry_;
  SubscriptionHeader & header_;
  EndpointEntry & entry_;
  Peers publishers_;
  bool lacks_some_ =
    false;  ///< for want of memory, or of their cluster: their hints were passed over
  std::vector<Source> sources_;  ///< ordered by slot; a slot has one
};

}  // namespace manycore
