// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/peers/endpoint_terms.hpp"
#include "transport/registry/registry.hpp"
#include "transport/registry/snapshot.hpp"

namespace manycore {

/// An endpoint at the other end, as in its row.
struct Peer {
  uint32_t slot;
  uint32_t incarnation;
  uint32_t process;
  SegmentRef block;
  Gid gid;
  Reliability reliability;
  Durability durability;
  Liveliness liveliness;
};

/// The endpoints with which one endpoint is matched, in a private list that is renewed when
/// `changes` of the topic's bucket moved. Takes no lock. Used by one thread at a time.
///
/// A walk begins at the youngest endpoint and ends at the first one that an earlier walk has seen:
/// those behind it have been seen as well. A peer leaves the list only because its own row says
/// that it is gone, never because a walk did not find it. See docs/model/peers.pml.
class Peers {
public:
  /// Which rows are peers.
  enum class Of : uint8_t {
    live,
    with_memory,  ///< live publishers, and closed ones that may hold messages
  };

  /// `own` may be a copy of a row.
  Peers(Registry & registry, const EndpointEntry & own, Of of = Of::live);

  /// True if there were changes of rows since the last call, which need not concern this list. May
  /// throw std::bad_alloc; then the next call looks again. The load of `changes` is seq_cst.
  bool refresh();
  /// The next refresh() looks at the rows again.
  void forget_changes() noexcept { has_looked_ = false; }

  /// The youngest ones last.
  const std::vector<Peer> & all() const noexcept { return peers_; }
  const EndpointTerms & own() const noexcept { return own_; }

  /// Since the creation of this list, as far as its refreshes have seen.
  struct Counts {
    uint64_t matched_total = 0;
    uint64_t incompatible_qos = 0;
    QosPolicy last_policy = QosPolicy::none;
    uint64_t incompatible_types = 0;
    /// Publishers whose process was killed, and that no later one has replaced.
    uint64_t died = 0;
  };
  const Counts & counts() const noexcept { return counts_; }

private:
  enum class Presence : uint8_t { there, left, died };
  Presence presence_of(const Peer & peer) const noexcept;
  void drop_gone() noexcept;
  void find_new();
  void consider(uint32_t slot, const EntryCopy<EndpointEntry> & row);
  /// True for an endpoint that an earlier walk has seen.
  bool is_known(uint32_t order) const noexcept;

  Registry & registry_;
  const EndpointTerms own_;
  const Of of_;
  std::vector<Peer> peers_;
  std::vector<Peer> found_;  ///< by the walk under way, the youngest first
  Counts counts_;
  Counts found_counts_;
  uint64_t seen_changes_ = 0;
  bool has_looked_ = false;
  bool has_walked_ = false;
  uint32_t newest_order_ = 0;  ///< of an endpoint seen by an earlier walk
};

}  // namespace manycore
