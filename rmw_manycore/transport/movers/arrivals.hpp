// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/registry/registry.hpp"
#include "transport/transfer/landing.hpp"

namespace manycore {

/// Where a mover has to put a record. Good while its phase is odd.
struct Destination {
  const Cluster & source;
  TopicDsmHeader & dsm;
  const Cluster & receiver;
  Landing landing;
};

/// Nothing when the record's publisher, or its last subscription in `receiver`, has gone, or the
/// announcement is a stranger's.
std::optional<Destination> destination_of(
  Registry & registry, const EmcosMessage & announcement, uint32_t receiver) noexcept;

/// False for a record that readers have done with: of a use of the landing before this one, or a
/// stranger's.
bool is_awaited(const Destination & to, uint64_t number) noexcept;

/// The record is in its landing: notifies the receive thread.
void note_arrival(
  Registry & registry, const Destination & to, const EmcosMessage & announcement) noexcept;

/// The record was handed over and will not get there: has the readers look, which count it as lost.
void note_loss(Registry & registry, const Destination & to, uint64_t number) noexcept;

/// Records that were handed over before a mover started. Its predecessor may have received some,
/// and not copied them, when it was killed: what the pipe does not have any more never arrives.
class HandedBefore {
public:
  /// Of landings of topics transferred by `kind` that this mover fills: `in` a cluster, or `from`
  /// one.
  static HandedBefore look(Registry & registry, Transfer kind, uint32_t cluster);
  /// Gives up those that are still missing once the mover has handled what was in its pipe after
  /// look(). `phase`: the mover's.
  void give_up_missing(Registry & registry, std::atomic<uint64_t> & phase) noexcept;

private:
  /// Has an effect if the slot holds a publisher whose landings this mover fills.
  void look_at(Registry & registry, uint32_t slot, Transfer kind, uint32_t cluster);

  struct Entry {
    EmcosMessage announcement;
    uint32_t receiver;
  };
  std::vector<Entry> entries_;
};

}  // namespace manycore
