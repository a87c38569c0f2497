// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/landings.hpp"

#include "transport/transfer/landing.hpp"
#include "transport/transfer/sessions.hpp"

namespace manycore::landings {
namespace {

/// Nothing that was published before is on its way there.
void begin(LandingHeader & landing, uint64_t last) noexcept {
  for (std::atomic<uint64_t> * word :
       {&landing.arrived, &landing.done, &landing.handed, &landing.closed}) {
    word->store(last, std::memory_order_seq_cst);
  }
}

void name_publisher(LandingHeader & landing, const TopicDsmHeader & dsm) noexcept {
  landing.endpoint.store(dsm.endpoint.load());
  landing.incarnation.store(dsm.incarnation.load());
  landing.magic.store(landing_magic, std::memory_order_release);
}

/// A retired landing that is not being freed yet, or nullptr.
LandingHeader * whole_retired(
  const LandingTable & table, const TopicDsmHeader & dsm, const Cluster & receiver) noexcept {
  const uint64_t offset = table.retired[receiver.id() - 1].load();
  const bool is_whole = offset != 0 && table.kept_pieces[receiver.id() - 1].load() == 0;
  return is_whole ? receiver.find<LandingHeader>(offset, landing_bytes(dsm)) : nullptr;
}

void retire(LandingTable & table, uint32_t receiver) noexcept {
  if (table.landings[receiver - 1].load() != 0) {
    table.kept_pieces[receiver - 1].store(0);
    table.retired[receiver - 1].store(table.landings[receiver - 1].load());
    // Dekker with publisher and movers: each stores its phase before it looks for the landing.
    table.landings[receiver - 1].store(0, std::memory_order_seq_cst);
  }
}

}  // namespace

Place find_place(
  Registry & registry, const EndpointEntry & publisher, TopicDsmHeader & dsm,
  const Cluster & receiver, const SpareBlock & spare) {
  const LandingTable * const table = landing_table(registry.clusters().at(publisher.cluster), dsm);
  if (
    table == nullptr || receiver.id() == publisher.cluster ||
    table->landings[receiver.id() - 1].load() != 0) {
    return Place::ready;
  }
  if (publisher.transfer == Transfer::session) {
    require_free_session(registry, publisher, receiver.id());
  }
  if (whole_retired(*table, dsm, receiver) != nullptr) {
    return Place::ready;
  }
  if (table->retired[receiver.id() - 1].load() != 0) {
    return Place::retiring;
  }
  const bool is_made = spare.fits(SpareUse::landing, receiver.id(), landing_bytes(dsm));
  return is_made ? Place::ready : Place::missing;
}

void attach(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver, SpareBlock & spare) {
  LandingTable * const table = landing_table(cluster, dsm);
  if (
    table == nullptr || receiver.id() == cluster.id() ||
    table->landings[receiver.id() - 1].load() != 0) {
    return;
  }
  LandingHeader * landing = whole_retired(*table, dsm, receiver);
  if (landing == nullptr) {
    landing = receiver.find<LandingHeader>(spare.take().offset(), landing_bytes(dsm));
    if (landing == nullptr) {
      return;  // damaged
    }
    name_publisher(*landing, dsm);
  }
  begin(*landing, dsm.last.load(std::memory_order_seq_cst));
  table->landings[receiver.id() - 1].store(
    receiver.ref_of(landing).offset(), std::memory_order_seq_cst);
  table->retired[receiver.id() - 1].store(0);
}

void count_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters) {
    table->readers[receiver - 1].fetch_add(1);
  }
}

void discount_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters && table->readers[receiver - 1].load() != 0) {
    table->readers[receiver - 1].fetch_sub(1);
  }
}

void forget_readers(const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t i = 0; table != nullptr && i < max_clusters; ++i) {
    table->readers[i].store(0);
  }
}

void retire_unread(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table != nullptr && receiver - 1 < max_clusters && table->readers[receiver - 1].load() == 0) {
    retire(*table, receiver);
  }
}

bool has_retired(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  const LandingTable * const table = landing_table(cluster, dsm);
  return table != nullptr && table->retired[receiver - 1].load() != 0 &&
         table->landings[receiver - 1].load() == 0;
}

/// The table forgets the piece before it is freed: a landing with a hole must never be taken up
/// again. If this process dies in between, the next owner of the lock builds the map without the
/// piece, whose memory stays until it is allocated again.
bool free_piece_of_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, Cluster & receiver) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  if (table == nullptr) {
    return true;
  }
  std::atomic<uint32_t> & kept_pieces = table->kept_pieces[receiver.id() - 1];
  const Cluster::LastPiece piece = receiver.last_piece(
    table->retired[receiver.id() - 1].load(), landing_bytes(dsm), kept_pieces.load());
  const bool is_last = piece.kept_pieces == 0;
  if (is_last) {
    table->retired[receiver.id() - 1].store(0);
  } else {
    kept_pieces.store(piece.kept_pieces);
  }
  receiver.free_part(piece.offset, piece.length, landing_bytes(dsm));
  return is_last;
}

bool is_being_freed(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept {
  const LandingTable * const table = landing_table(cluster, dsm);
  return table != nullptr && table->retired[receiver - 1].load() != 0 &&
         table->kept_pieces[receiver - 1].load() != 0;
}

Cluster * retire_next(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    if (table->landings[id - 1].load() == 0 && table->retired[id - 1].load() == 0) {
      continue;
    }
    if (Cluster * const receiver = registry.map_cluster(id)) {
      retire(*table, id);
      return receiver;
    }
  }
  return nullptr;
}

void mark_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const uint64_t used = table->landings[id - 1].load();
    const uint64_t offset = used != 0 ? used : table->retired[id - 1].load();
    Cluster * const receiver = offset == 0 ? nullptr : clusters.find(id);
    if (receiver != nullptr) {
      const uint32_t kept_pieces = used != 0 ? 0 : table->kept_pieces[id - 1].load();
      receiver->mark_allocated(offset, kept_bytes(offset, landing_bytes(dsm), kept_pieces));
    }
  }
}

void close_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  LandingTable * const table = landing_table(cluster, dsm);
  for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
    const Cluster * const receiver =
      table->landings[id - 1].load() == 0 ? nullptr : clusters.find(id);
    const Landing landing = receiver == nullptr ? Landing() : Landing::of(cluster, dsm, *receiver);
    if (landing) {
      landing.header().closed.store(dsm.last.load(), std::memory_order_seq_cst);
    }
  }
}

}  // namespace manycore::landings
