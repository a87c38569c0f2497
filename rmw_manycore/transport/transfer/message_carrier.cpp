// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/message_carrier.hpp"

#include <algorithm>
#include <cstring>

#include "platform/clock.hpp"

namespace manycore {
namespace {

/// Until the record is in the landing, or was given up, or the time is over.
bool wait_for_arrival(LandingHeader & landing, uint64_t number, int64_t until_ns) noexcept {
  while (landing.done.load(std::memory_order_seq_cst) < number && monotonic_ns() < until_ns) {
    const uint32_t seen = landing.progress.load(std::memory_order_seq_cst);
    landing.sender_waits.store(1, std::memory_order_seq_cst);
    if (landing.done.load(std::memory_order_seq_cst) < number) {
      futex_wait(landing.progress, seen, until_ns);
    }
    landing.sender_waits.store(0, std::memory_order_relaxed);
  }
  return landing.done.load(std::memory_order_seq_cst) >= number;
}

}  // namespace

const Pipe * MessageCarrier::pipe_to(uint32_t cluster) noexcept {
  std::optional<Pipe> & pipe = pipes_[cluster - 1];
  if (!pipe) {
    try {
      pipe.emplace(Pipe::open(paths_.data_pipe(cluster, settings_.priority)));
    } catch (const std::exception &) {
      return nullptr;  // no descriptor left, or the platform's files are gone: others say so
    }
  }
  return &*pipe;
}

bool MessageCarrier::send(
  const Pipe & pipe, const Packet & packet, int64_t until_ns) const noexcept {
  while (!pipe.try_send(&packet, sizeof packet)) {
    if (settings_.synchronous == 0 || !pipe.wait_for_room(until_ns)) {
      return false;
    }
  }
  return true;
}

/// A record without bytes is one packet without data.
Carried MessageCarrier::carry(
  const Parcel & parcel, const Landing & landing, const Cluster & receiver) noexcept {
  const Pipe * const pipe = pipe_to(receiver.id());
  if (pipe == nullptr) {
    return Carried::dropped;
  }
  packet_.announcement = parcel.announcement;
  packet_.place = parcel.place;
  packet_.offset = 0;
  do {
    packet_.size_bytes = static_cast<uint32_t>(
      std::min<uint64_t>(parcel.place.size_bytes - packet_.offset, sizeof packet_.data));
    std::memcpy(packet_.data, parcel.data + packet_.offset, packet_.size_bytes);
    if (!send(*pipe, packet_, parcel.until_ns)) {
      return Carried::dropped;
    }
    packet_.offset += packet_.size_bytes;
  } while (packet_.offset < parcel.place.size_bytes);
  const bool is_in_time =
    settings_.synchronous == 0 ||
    wait_for_arrival(landing.header(), parcel.announcement.number, parcel.until_ns);
  return is_in_time ? Carried::handed : Carried::unconfirmed;
}

}  // namespace manycore
