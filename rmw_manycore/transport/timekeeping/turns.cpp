// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Timekeeper: which thread goes on next.

#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {

using virtual_time::no_process;
using virtual_time::seat_running;
using virtual_time::seat_waiting;

bool Timekeeper::is_ready(const Seat & seat) {
  if (seat.next != virtual_time::Step::none) {
    return false;
  }
  if (seat.due_ns <= page_.now_ns.load(std::memory_order_relaxed)) {
    return true;
  }
  if (seat.process == no_process || seat.process >= registry_.processes().high_water()) {
    return false;
  }
  const WakeWords & wake = registry_.processes()[seat.process].wake;
  return wake.words[seat.word % wake_words_per_process].epoch.load() != seat.seen;
}

Timekeeper::Key Timekeeper::key_of(const Seat & seat) const {
  const auto & processes = programs_.at(seat.rank).processes;
  const auto process = processes.find(seat.pid);
  const uint32_t number = process == processes.end() ? UINT32_MAX : process->second.number;
  return {seat.rank, number, seat.pid, seat.ordinal};
}

/// The ready seat that follows the one let go last, in the cyclic order of programs and threads: so
/// two programs that answer each other do not keep a third one waiting.
Timekeeper::Seat * Timekeeper::next_ready() {
  Seat * first = nullptr;
  Seat * following = nullptr;
  for_each_seat([&](Seat & seat) {
    if (seat.state.load(std::memory_order_acquire) != seat_waiting || !is_ready(seat)) {
      return;
    }
    const Key key = key_of(seat);
    if (first == nullptr || key < key_of(*first)) {
      first = &seat;
    }
    if (key > last_ && (following == nullptr || key < key_of(*following))) {
      following = &seat;
    }
  });
  return following != nullptr ? following : first;
}

void Timekeeper::let_go(Seat & seat) {
  Program & program = programs_.at(seat.rank);
  program.joined +=
    program.processes.try_emplace(seat.pid, seat.pid, program.joined).second ? 1 : 0;
  active_.emplace(Turn{program, seat.pid});
  ++steps_;
  seat.state.store(seat_running, std::memory_order_release);
  futex_wake_one(seat.state);
}

}  // namespace manycore
