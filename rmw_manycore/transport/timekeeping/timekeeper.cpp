// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/timekeeping/timekeeper.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdio>

#include "platform/clock.hpp"
#include "platform/os_process.hpp"

namespace manycore {
namespace {

using virtual_time::never_ns;
using virtual_time::seat_free;
using virtual_time::seat_waiting;

/// Time that a thread may run before the kernel is asked what it does.
constexpr int64_t look_after_ns = 1'000'000;
constexpr int64_t idle_ns = 5'000'000;
constexpr int64_t short_pause_ns = 50'000;
/// Wall time after which whatever holds time still is named.
constexpr int64_t report_after_ns = 5 * ns_per_s;
/// How long the rows of a dead process may stay in the registry.
constexpr int64_t reaping_ns = 2 * ns_per_s;

bool has_ended(const FileDescriptor & pidfd) noexcept {
  pollfd readable{pidfd.get(), POLLIN, 0};
  return !pidfd || poll(&readable, 1, 0) > 0;
}

}  // namespace

Timekeeper::Timekeeper(Registry & registry, virtual_time::Page & page, PlatformModel * model)
: registry_(registry), page_(page), model_(model) {}

Timekeeper::Process::Process(pid_t pid, uint32_t number_)
: pidfd(open_pidfd(pid)), threads(pid), number(number_) {}

Timekeeper::Process * Timekeeper::Turn::process() const {
  const auto found = program.processes.find(pid);
  return found == program.processes.end() ? nullptr : &found->second;
}

void Timekeeper::run() {
  while (!is_over_) {
    take_commands();
    const uint32_t seen = page_.changes.load(std::memory_order_seq_cst);
    if (!has_begun_ || is_frozen_ || is_held_ || !step()) {
      pause(seen, idle_ns);
    }
  }
  finish();
}

/// One step of the order; false if there is nothing to do before a command comes.
bool Timekeeper::step() {
  if (active_) {
    settle(*active_);
    drain();
    ask_model();
    active_.reset();
    hold_if_published();
    return true;
  }
  for (auto & [rank, program] : programs_) {
    note_ends(program);
    note_due(rank, program);
    if (program.state == Program::State::starting) {
      await_join(rank, program);
      return true;
    }
    if (program.state == Program::State::ended) {
      return false;
    }
  }
  if (Seat * const seat = next_ready()) {
    last_ = key_of(*seat);
    let_go(*seat);
    return true;
  }
  last_ = {};  // at another time, the order begins with the first program again
  advance();
  return !is_frozen_ && page_.now_ns.load() != never_ns;
}

void Timekeeper::take_commands() {
  for (const Command & command : commands_.take()) {
    obey(command);
  }
}

void Timekeeper::obey(const Command & command) {
  switch (command.kind) {
    case Command::Kind::start: {
      Program & program = programs_[command.rank];
      note_ends(program);  // of the process before, unless it was noted
      program.name = command.name;
      program.leader = open_pidfd(command.pid);
      program.started_ns = monotonic_ns();
      program.state = Program::State::starting;
      program.due_ns = never_ns;
      break;
    }
    case Command::Kind::gone:
    case Command::Kind::later: {
      const bool is_later = command.kind == Command::Kind::later;
      Program & program = programs_[command.rank];
      note_ends(program);
      program.state = Program::State::gone;
      program.due_ns = is_later ? page_.now_ns.load() + command.duration_ns : never_ns;
      note_due(command.rank, program);
      break;
    }
    case Command::Kind::go:
      has_begun_ = true;
      end_ns_ = command.duration_ns > 0 ? virtual_time::start_ns + command.duration_ns : never_ns;
      break;
    case Command::Kind::kill:
      kills_.emplace(virtual_time::start_ns + command.duration_ns, command.rank);
      break;
    case Command::Kind::hold:
      hold("paused");
      break;
    case Command::Kind::resume:
      resume(command.duration_ns, command.name);
      break;
    case Command::Kind::over:
      is_over_ = true;
      break;
  }
}

/// Programs start one after the other, in their order: so endpoints are created in one order.
void Timekeeper::await_join(uint32_t rank, Program & program) {
  const uint32_t seen = page_.changes.load(std::memory_order_seq_cst);
  Seat * joining = nullptr;
  for_each_seat([&](Seat & seat) {
    const bool waits = seat.state.load(std::memory_order_acquire) == seat_waiting;
    const bool is_new = waits && seat.rank == rank && program.processes.count(seat.pid) == 0;
    if (is_new && (joining == nullptr || key_of(seat) < key_of(*joining))) {
      joining = &seat;
    }
  });
  if (joining != nullptr) {
    program.state = Program::State::joined;
    let_go(*joining);
  } else if (has_ended(program.leader)) {
    program.state = Program::State::ended;
  } else {
    if (monotonic_ns() - program.started_ns > 2 * report_after_ns) {
      report_still(program.name + " has not called rmw_init: is it a ROS 2 program?");
    }
    pause(seen, idle_ns);
  }
}

/// Waits until no thread of a process that was let go can do anything more at this time.
void Timekeeper::settle(const Turn & turn) {
  const int64_t started_ns = monotonic_ns();
  int64_t pause_ns = short_pause_ns;
  while (!is_over_) {
    const uint32_t seen = page_.changes.load(std::memory_order_seq_cst);
    const int64_t waited_ns = monotonic_ns() - started_ns;
    if (waited_ns > look_after_ns) {
      note_ends(turn.program);
    }
    Process * const process = turn.process();
    if (process == nullptr || is_quiet(turn.pid, *process, waited_ns > look_after_ns)) {
      return;
    }
    if (waited_ns > report_after_ns) {
      const Members own = members(turn.pid);
      const auto look = process->threads.look(own.waiting, own.running);
      report_still(
        turn.program.name + (look.doing.empty() ? " computes" : " " + look.doing) +
        (look.tid == 0 ? "" : " (thread " + std::to_string(look.tid) + ")"));
    }
    pause(seen, pause_ns);
    pause_ns = std::min(2 * pause_ns, idle_ns);
  }
}

Timekeeper::Members Timekeeper::members(pid_t pid) const {
  Members found;
  for_each_seat([&](const Seat & seat) {
    const uint32_t state = seat.state.load(std::memory_order_acquire);
    if (state != seat_free && seat.pid == pid) {
      (state == seat_waiting ? found.waiting : found.running).push_back(seat.tid);
    }
  });
  return found;
}

/// A thread that was let go and sleeps in a lock waits for others of its process; then one of them
/// must wait for the timekeeper, or they wait for another process. `looks`: also ask the kernel
/// about threads that were let go.
bool Timekeeper::is_quiet(pid_t pid, Process & process, bool looks) {
  const Members own = members(pid);
  if (own.waiting.empty() || (!own.running.empty() && !looks)) {
    return false;
  }
  return process.threads.look(own.waiting, own.running).asleep;
}

/// Notes which processes of a program have ended. After the last one time stands: the leader starts
/// another one, or ends.
void Timekeeper::note_ends(Program & program) {
  for (auto one = program.processes.begin(); one != program.processes.end();) {
    if (!has_ended(one->second.pidfd)) {
      ++one;
      continue;
    }
    note_end(one->first);
    one = program.processes.erase(one);
    if (program.processes.empty() && program.state == Program::State::joined) {
      program.state = Program::State::starting;
      program.started_ns = monotonic_ns();
    }
  }
}

/// Frees the seats of a dead process, also one that it was taking, and waits until its endpoints
/// are removed, which happens in wall time: so the others learn of it at this virtual time.
void Timekeeper::note_end(pid_t pid) {
  for (Seat & seat : page_.seats) {
    if (seat.pid == pid) {
      seat.vacate();
    }
  }
  const auto is_listed = [&] {
    bool found = false;
    for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
      found =
        found || (registry_.processes().is_live(slot) && registry_.processes()[slot].pid == pid);
    }
    return found;
  };
  const int64_t until_ns = monotonic_ns() + reaping_ns;
  while (is_listed() && monotonic_ns() < until_ns) {
    futex_wait(page_.changes, page_.changes.load(), monotonic_ns() + short_pause_ns);
  }
}

/// Time stands until the run has started a program that is due.
void Timekeeper::note_due(uint32_t rank, Program & program) {
  if (program.due_ns <= page_.now_ns.load()) {
    program.due_ns = never_ns;
    program.state = Program::State::ended;
    report("due", std::to_string(rank));
  }
}

/// Waits until the receive threads have forwarded what was sent.
void Timekeeper::drain() {
  const int64_t started_ns = monotonic_ns();
  while (!is_over_ && !is_drained()) {
    if (monotonic_ns() - started_ns > report_after_ns) {
      report_still("a receive thread is busy");
    }
    pause(page_.changes.load(std::memory_order_seq_cst), short_pause_ns);
  }
}

/// A message in a pipe has made its reader runnable before the sender's write() returned, so
/// readers that sleep have read all.
bool Timekeeper::is_drained() {
  for (uint32_t id = 1; id <= registry_.header().profile.clusters; ++id) {
    Cluster * const cluster = registry_.clusters().find(id);
    const pid_t pid = cluster == nullptr ? 0 : cluster->header().receive_thread_pid.load();
    if (pid == 0) {
      continue;
    }
    ProcessThreads & threads = receive_threads_.try_emplace(pid, pid).first->second;
    if (!threads.look({}, {}).asleep) {
      return false;
    }
  }
  return true;
}

int64_t Timekeeper::next_due_ns() const {
  int64_t next_ns = never_ns;
  for_each_seat([&](const Seat & seat) {
    if (seat.state.load(std::memory_order_acquire) == seat_waiting) {
      next_ns = std::min(next_ns, seat.due_ns);
    }
  });
  return next_ns;
}

int64_t Timekeeper::next_start_ns() const {
  int64_t next_ns = never_ns;
  for (const auto & [_, program] : programs_) {
    next_ns = std::min(next_ns, program.due_ns);
  }
  return next_ns;
}

/// Nothing can happen at this time any more: on to when the next wait is due.
void Timekeeper::advance() {
  const int64_t next_ns = next_due_ns();
  const int64_t kill_ns = kills_.empty() ? never_ns : kills_.begin()->first;
  const int64_t start_ns = next_start_ns();
  const int64_t others_ns = std::min({next_ns, end_ns_, stop_ns_});
  if (model_ != nullptr && advance_model(std::min({others_ns, kill_ns, start_ns}))) {
    if (is_single_) {
      hold("something is due");
    }
    return;
  }
  if (start_ns <= others_ns && start_ns < kill_ns) {
    page_.now_ns.store(start_ns, std::memory_order_release);
    return;
  }
  if (kill_ns <= others_ns && kill_ns != never_ns) {
    page_.now_ns.store(kill_ns, std::memory_order_release);
    kill_due();
    return;
  }
  if (stop_ns_ < std::min(next_ns, end_ns_)) {
    page_.now_ns.store(stop_ns_, std::memory_order_release);
    hold("the step is over");
    return;
  }
  if (end_ns_ <= next_ns && end_ns_ != never_ns) {
    page_.now_ns.store(end_ns_, std::memory_order_release);
    is_frozen_ = true;
    report("end", std::to_string(steps_));
  } else if (next_ns != never_ns) {
    page_.now_ns.store(next_ns, std::memory_order_release);
    if (is_single_) {
      hold("something is due");
    }
  } else {
    pause(page_.changes.load(std::memory_order_seq_cst), idle_ns);  // something from outside
  }
}

void Timekeeper::finish() {
  page_.end();
  for_each_seat([](Seat & seat) { futex_wake_all(seat.state); });
}

void Timekeeper::pause(uint32_t seen, int64_t ns) {
  futex_wait(page_.changes, seen, monotonic_ns() + ns);
  take_commands();
  end_if_full();
}

/// A thread without a seat lives in wall time: the run would go on, but not be repeatable.
void Timekeeper::end_if_full() {
  const pid_t pid = page_.seatless.exchange(0);
  if (pid == 0 || is_over_) {
    return;
  }
  std::string name = "process " + std::to_string(pid);
  for_each_seat([&](const Seat & seat) {
    const auto program = programs_.find(seat.rank);
    if (seat.pid == pid && program != programs_.end()) {
      name = program->second.name;
    }
  });
  is_over_ = true;
  report(
    "broken", name + " has one thread too many: " + std::to_string(virtual_time::seat_capacity) +
                " may wait at a time");
}

void Timekeeper::report(const char * kind, const std::string & text) const {
  std::printf("%s %s\n", kind, text.c_str());
  std::fflush(stdout);
}

void Timekeeper::report_still(const std::string & what) {
  if (reported_.insert(what).second) {
    const int64_t ms = (page_.now_ns.load() - virtual_time::start_ns) / 1'000'000;
    report("still", std::to_string(ms) + " " + what);
  }
}

}  // namespace manycore
