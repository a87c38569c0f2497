// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/transfer/arrived.hpp"
#include "transport/transfer/transfer_pipes.hpp"
#include "transport/transfer/transfer_sender.hpp"

/// The door to transfers: all that other folders, but for the movers, know of them. A topic that is
/// not transferred passes through it like any other, and nothing is done. A publisher hands its
/// records to a TransferSender, a subscription finds them by Arrived; the functions make and free
/// the memory that its records need in other clusters. Unless stated otherwise the caller holds the
/// registry lock, and `cluster` is that of the topic DSM. See docs/design/transfers.md.
namespace manycore::transfer {

/// How an endpoint's topic is transferred; `configured` is its line of the topic table, or nullptr.
/// Needs no lock. Throws Error{unsupported} for a publisher whose QoS a transfer cannot keep.
Transfer kind_of(const TopicEntry * configured, const EndpointSpec & spec, EndpointKind kind);

/// A publisher and a subscription in another cluster, with which it is matched.
struct Ends {
  uint32_t publisher;
  uint32_t publisher_incarnation;
  uint32_t subscription;
  uint32_t subscription_incarnation;
};

/// Makes room for the publisher's records in the cluster of the subscription, unless there is some,
/// or one of them has left. This process has mapped both clusters. Takes the registry lock. Throws
/// Error{no_space}, also for a ninth session, with the names of the eight, and the errors of
/// `membership`.
void make_room(Registry & registry, const Membership & membership, const Ends & ends);

/// True where publisher's records reach `receiver` in room of their own, and have it.
bool has_room(const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver) noexcept;
/// Once `receiver` has no reader left: no thread finds the publisher's room there from here on.
void retire(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;
/// Takes up what was retired in `receiver`, if it was and the publisher is out of its phase; all
/// movers have been seen out of theirs since. False if it was not taken up.
bool take_up_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept;

/// A publisher that is gone hands nothing more over: its readers need not wait for it.
void end(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;
/// False if what a subscription has not taken of a publisher that is gone never reaches it: no
/// mover goes on, and none of it has arrived. What a dead mover left without a hint, the
/// subscription is set to look for. Throws ClusterUnmappable.
bool can_arrive(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm,
  SubscriptionHeader & subscription, uint32_t receiver, const Seat & seat);
/// Takes up what a topic DSM to which no reference leads any more has in other clusters, while its
/// generations say how large that is. False once the hand is full. Throws ClusterUnmappable.
bool take_up_all(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, BlockInHand & hand);

/// Rebuilding the maps of the clusters.
void mark(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

}  // namespace manycore::transfer
