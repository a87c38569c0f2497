// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Room for a publisher's records in the cluster of a subscription: the block comes about in the
// hand of the process, and is attached if it is still needed then (docs/model/landing.pml).
#include "transport/transfer/sessions.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::transfer {
namespace {

NeededBlock block_of_landing(const TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  const uint64_t bytes = landing_bytes(dsm);
  const uint64_t data_bytes = dsm.generations[0].data_bytes.load(std::memory_order_relaxed);
  return {receiver.id(), bytes, bytes - data_bytes, true};
}

/// One that the last subscription there has left, and that is not freed yet.
LandingHeader * retired_landing(
  const LandingTable & table, const TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  const uint64_t offset = table.retired[receiver.id() - 1].load();
  return offset != 0 ? receiver.find<LandingHeader>(offset, landing_bytes(dsm)) : nullptr;
}

void name_publisher(LandingHeader & landing, const TopicDsmHeader & dsm) noexcept {
  landing.endpoint.store(dsm.endpoint.load());
  landing.incarnation.store(dsm.incarnation.load());
  landing.magic.store(landing_magic, std::memory_order_release);
}

/// From here on records arrive there; none that was published before is on its way.
void attach(
  LandingTable & table, TopicDsmHeader & dsm, const Cluster & receiver,
  LandingHeader & landing) noexcept {
  const uint64_t last = dsm.last.load(std::memory_order_seq_cst);
  for (std::atomic<uint64_t> * word :
       {&landing.arrived, &landing.done, &landing.handed, &landing.decided}) {
    word->store(last, std::memory_order_seq_cst);
  }
  table.landings[receiver.id() - 1].store(
    receiver.ref_of(&landing).offset(), std::memory_order_seq_cst);
  table.retired[receiver.id() - 1].store(0);
}

void attach_block(
  LandingTable & table, TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept {
  LandingHeader * const landing =
    receiver.find<LandingHeader>(hand.block().offset(), landing_bytes(dsm));
  if (landing != nullptr) {  // else damaged
    name_publisher(*landing, dsm);
    attach(table, dsm, receiver, *landing);
    hand.let_go();
  }
}

bool is_there(Registry & registry, uint32_t slot, uint32_t incarnation) {
  return registry.endpoints().is_live(slot) &&
         registry.endpoints()[slot].slot.incarnation.load() == incarnation;
}

/// Attaches a landing if it is wanted and none is there. Returns the block that has to be in hand
/// first. The caller holds the registry lock.
std::optional<NeededBlock> try_to_attach(
  Registry & registry, const Ends & ends, BlockInHand * hand) {
  if (
    !is_there(registry, ends.publisher, ends.publisher_incarnation) ||
    !is_there(registry, ends.subscription, ends.subscription_incarnation)) {
    return std::nullopt;
  }
  const EndpointEntry & publisher = registry.endpoints()[ends.publisher];
  const Cluster & cluster = registry.clusters().at(publisher.cluster);
  Cluster & receiver = registry.clusters().at(registry.endpoints()[ends.subscription].cluster);
  auto * const dsm = cluster.find<TopicDsmHeader>(publisher.block.offset());
  if (dsm == nullptr) {
    throw Error(
      ErrorCode::corrupt, "the registry is damaged; stop the nodes, run 'manycore clean'");
  }
  LandingTable * const table = landing_table(cluster, *dsm);
  if (table == nullptr || table->landings[receiver.id() - 1].load() != 0) {
    return std::nullopt;
  }
  if (publisher.transfer == Transfer::session) {
    require_free_session(registry, publisher, receiver.id());
  }
  if (LandingHeader * const landing = retired_landing(*table, *dsm, receiver)) {
    attach(*table, *dsm, receiver, *landing);
  } else {
    const NeededBlock needed = block_of_landing(*dsm, receiver);
    if (hand == nullptr || !hand->has(needed)) {
      return needed;
    }
    attach_block(*table, *dsm, receiver, *hand);
  }
  registry.raise_changes(publisher.topic_hash);
  return std::nullopt;
}

/// False if there is no room, and no endpoint that is created at the same time was making the same
/// block: the next attempt may find that.
bool make_block(BlockInHand & hand, const Membership & membership, const NeededBlock & needed) {
  try {
    hand.make(membership, needed);
    return true;
  } catch (const Error & error) {
    if (error.code() != ErrorCode::no_space) {
      throw;
    }
    return hand.await_another(needed);
  }
}

}  // namespace

/// Another endpoint's block may have been attached since the last attempt, so a lack of room is an
/// error only the second time.
void make_room(Registry & registry, const Membership & membership, const Ends & ends) {
  std::optional<BlockInHand> hand;
  bool lacks_room = false;
  while (true) {
    std::optional<NeededBlock> needed;
    {
      const Registry::Lock lock(registry);
      membership.require();
      needed = try_to_attach(registry, ends, hand ? &*hand : nullptr);
    }
    if (!needed) {
      return;
    }
    if (!hand) {
      hand.emplace(registry);
    }
    if (lacks_room) {
      hand->make(membership, *needed);
    }
    lacks_room = !lacks_room && !make_block(*hand, membership, *needed);
  }
}

}  // namespace manycore::transfer
