// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/movers/copy_mover.hpp"

#include <algorithm>
#include <cstring>

#include "transport/registry/odd_phase.hpp"

namespace manycore {

CopyMover::CopyMover(Registry & registry, uint32_t cluster)
: registry_(registry),
  cluster_(registry.clusters().at(cluster)),
  phase_(cluster_.header().mover_phases[1]),
  requests_(Pipe::open(registry.paths().session_pipe(cluster))),
  batch_(batch_size) {}

void CopyMover::run() {
  recover();
  while (true) {
    receive(batch_.size());
  }
}

size_t CopyMover::receive(size_t max_count) {
  const size_t count =
    requests_.receive(batch_.data(), max_count * sizeof(CopyRequest)) / sizeof(CopyRequest);
  for (size_t i = 0; i < count; ++i) {
    handle(batch_[i]);
  }
  return count;
}

void CopyMover::handle(const CopyRequest & request) noexcept {
  const OddPhase phase(phase_);
  const EmcosMessage & announcement = request.announcement;
  const auto to = destination_of(registry_, announcement, request.to_cluster);
  if (!to || !is_awaited(*to, announcement.number)) {
    return;
  }
  if (copy(request, *to)) {
    note_arrival(registry_, *to, announcement);
  } else {
    note_loss(registry_, *to, announcement.number);
  }
}

/// The publisher takes the number out of the descriptor before it writes over the bytes. So a
/// number that is still there after the copy proves that it is whole (acquire fence: the bytes were
/// read before it).
bool CopyMover::copy(const CopyRequest & request, const Destination & to) const noexcept {
  const uint64_t number = request.announcement.number;
  const GenerationEntry & only = to.dsm.generations[0];
  const uint64_t count = only.descriptor_count.load(std::memory_order_relaxed);
  const uint64_t begin = only.offset.load(std::memory_order_relaxed);
  const uint64_t data = only.data_offset() + request.place.begin;
  const auto * const descriptors =
    to.source.find<RecordDescriptor>(begin, count * sizeof(RecordDescriptor));
  const auto * const from = to.source.find<uint8_t>(data, request.place.size_bytes);
  uint8_t * const into = to.landing.find(request.place);
  if (descriptors == nullptr || from == nullptr || into == nullptr) {
    return false;
  }
  const std::atomic<uint64_t> & current = descriptors[number & (count - 1)].number;
  if (current.load(std::memory_order_acquire) != number) {
    return false;
  }
  std::memcpy(into, from, request.place.size_bytes);
  std::atomic_thread_fence(std::memory_order_acquire);
  return current.load(std::memory_order_relaxed) == number;
}

void CopyMover::recover() {
  phase_.store(0, std::memory_order_seq_cst);  // a dead predecessor's may be odd
  HandedBefore before = HandedBefore::look(registry_, Transfer::session, cluster_.id());
  for (size_t left = requests_.waiting_bytes() / sizeof(CopyRequest); left != 0;) {
    left -= receive(std::min(left, batch_.size()));
  }
  before.give_up_missing(registry_, phase_);
}

}  // namespace manycore
