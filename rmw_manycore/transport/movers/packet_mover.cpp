// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/movers/packet_mover.hpp"

#include <algorithm>
#include <cstring>

#include "transport/registry/odd_phase.hpp"
#include "transport/transfer/transfer_pipes.hpp"

namespace manycore {

PacketMover::PacketMover(Registry & registry, uint32_t cluster)
: registry_(registry),
  cluster_(registry.clusters().at(cluster)),
  phase_(cluster_.header().mover_phases[0]),
  batch_(batch_size) {
  for (const uint32_t priority : transfer_pipes::priorities(registry)) {
    pipes_.push_back(Pipe::open(registry.paths().data_pipe(cluster, priority)));
  }
}

void PacketMover::run() {
  recover();
  while (true) {
    receive(pipes_[Pipe::wait_for_first(pipes_)], batch_.size());
  }
}

/// Every packet is written whole and all have one size: what does not fit is a stranger's, and is
/// taken for packets of no publisher.
size_t PacketMover::receive(const Pipe & pipe, size_t max_count) {
  const size_t count = pipe.receive(batch_.data(), max_count * sizeof(Packet)) / sizeof(Packet);
  for (size_t i = 0; i < count; ++i) {
    handle(batch_[i]);
  }
  return count;
}

void PacketMover::handle(const Packet & packet) noexcept {
  const OddPhase phase(phase_);
  const auto to = destination_of(registry_, packet.announcement, cluster_.id());
  if (!to || !is_awaited(*to, packet.announcement.number) || !append(packet, *to)) {
    return;
  }
  LandingHeader & landing = to->landing.header();
  if (landing.partial_bytes.load(std::memory_order_relaxed) == packet.place.size_bytes) {
    landing.partial_number.store(no_record, std::memory_order_relaxed);
    note_arrival(registry_, *to, packet.announcement);
  }
}

/// The first packet of a record ends the one before it: the publisher dropped the rest, or a killed
/// mover had received some, and not copied them.
bool PacketMover::append(const Packet & packet, const Destination & to) const noexcept {
  LandingHeader & landing = to.landing.header();
  const uint64_t number = packet.announcement.number;
  const uint64_t partial = landing.partial_number.load(std::memory_order_relaxed);
  if (packet.offset == 0) {
    if (partial != no_record && partial != number) {
      to.landing.give_up(partial);
    }
    landing.partial_bytes.store(0, std::memory_order_relaxed);
    landing.partial_number.store(number, std::memory_order_relaxed);
  } else if (
    partial != number || landing.partial_bytes.load(std::memory_order_relaxed) != packet.offset) {
    return false;
  }
  uint8_t * const data = to.landing.find(packet.place);
  const bool is_inside = data != nullptr && packet.size_bytes <= sizeof packet.data &&
                         packet.offset <= packet.place.size_bytes &&
                         packet.size_bytes <= packet.place.size_bytes - packet.offset;
  if (is_inside) {
    std::memcpy(data + packet.offset, packet.data, packet.size_bytes);
    landing.partial_bytes.store(packet.offset + packet.size_bytes, std::memory_order_relaxed);
  }
  return is_inside;
}

void PacketMover::recover() {
  phase_.store(0, std::memory_order_seq_cst);  // a dead predecessor's may be odd
  HandedBefore before = HandedBefore::look(registry_, Transfer::message, cluster_.id());
  for (const Pipe & pipe : pipes_) {
    for (size_t left = pipe.waiting_bytes() / sizeof(Packet); left != 0;) {
      left -= receive(pipe, std::min(left, batch_.size()));
    }
  }
  before.give_up_missing(registry_, phase_);
}

}  // namespace manycore
