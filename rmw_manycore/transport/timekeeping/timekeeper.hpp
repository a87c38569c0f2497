// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "platform/file_descriptor.hpp"
#include "platform/process_threads.hpp"
#include "transport/registry/registry.hpp"
#include "transport/timekeeping/commands.hpp"
#include "transport/timekeeping/platform_model.hpp"
#include "virtual_time/door.hpp"
#include "virtual_time/seats.hpp"

namespace manycore {

/// Keeps the virtual time of a run: lets one thread at a time go on, in an order that depends on
/// nothing but virtual time and the order of the programs, and advances time when none can
/// (docs/design/virtual_time.md). The only writer of the time. Model: docs/model/virtual_time.pml.
class Timekeeper {
public:
  /// `model`: of the platform; nullptr: callbacks take the time in the page.
  Timekeeper(Registry & registry, virtual_time::Page & page, PlatformModel * model);

  /// Runs until the run is over; then time goes on at the pace of the wall clock.
  void run();

private:
  using Seat = virtual_time::Seat;

  /// A process that has joined.
  struct Process {
    Process(pid_t pid, uint32_t number);

    FileDescriptor pidfd;
    ProcessThreads threads;
    uint32_t number;  ///< of its program, in the order of joining
  };

  /// A program of the run, by its rank.
  struct Program {
    enum class State {
      starting,  ///< time stands until a process of it joins
      joined,
      ended,  ///< time stands until the run decides whether it is started again
      gone,
    };
    int64_t due_ns = virtual_time::never_ns;  ///< when it is to be started
    std::string name;
    State state = State::starting;
    int64_t started_ns = 0;  ///< CLOCK_MONOTONIC
    FileDescriptor leader;   ///< pidfd of the process that the run started; it may be a shell
    std::map<pid_t, Process> processes;  ///< one, or those that the leader has started
    uint32_t joined = 0;                 ///< processes ever
  };

  /// The order in which seats that are ready go on: of programs, their processes, and threads.
  /// Processes that join come after the others of their program, in the order of their ids.
  using Key = std::tuple<uint32_t, uint32_t, pid_t, uint32_t>;

  /// The process that was let go last.
  struct Turn {
    Program & program;
    pid_t pid;

    Process * process() const;  ///< nullptr once its end was noted
  };

  /// The threads of a process that wait for the timekeeper, and those that it let go on.
  struct Members {
    std::vector<pid_t> waiting;
    std::vector<pid_t> running;
  };

  void take_commands();
  void obey(const Command & command);
  bool step();
  void await_join(uint32_t rank, Program & program);
  void settle(const Turn & turn);
  bool is_quiet(pid_t pid, Process & process, bool looks);
  Members members(pid_t pid) const;
  void note_ends(Program & program);
  void note_end(pid_t pid);
  void note_due(uint32_t rank, Program & program);
  void drain();
  bool is_drained();
  Key key_of(const Seat & seat) const;
  Seat * next_ready();
  bool is_ready(const Seat & seat);
  void let_go(Seat & seat);
  void ask_model();
  void resume_model();
  void note(const PlatformModel::Passage & passage);
  std::string words_of(const Seat & seat) const;
  int64_t next_due_ns() const;
  int64_t next_start_ns() const;
  void advance();
  bool advance_model(int64_t until_ns);
  void kill_due();
  void finish();
  void hold(const std::string & why);
  void resume(int64_t duration_ns, const std::string & topic);
  void hold_if_published();
  uint64_t published() const;

  /// Sleeps until a seat changes after `seen`, at most `ns`; takes commands.
  void pause(uint32_t seen, int64_t ns);
  void report(const char * kind, const std::string & text) const;
  void report_still(const std::string & what);
  void end_if_full();
  template<typename Visit>
  void for_each_seat(Visit visit) const {
    const uint32_t count = std::min(page_.seat_count.load(), virtual_time::seat_capacity);
    for (uint32_t i = 0; i < count; ++i) {
      visit(page_.seats[i]);
    }
  }

  Registry & registry_;
  virtual_time::Page & page_;
  PlatformModel * const model_;
  std::map<uint32_t, pid_t> asked_;  ///< seats whose threads the model has in work
  bool is_model_waiting_ = false;    ///< for what threads do after its last answer
  CommandInput commands_;
  std::map<uint32_t, Program> programs_;
  std::map<pid_t, ProcessThreads> receive_threads_;
  std::set<std::string> reported_;
  std::optional<Turn> active_;  ///< until it has settled
  Key last_{};                  ///< of the seat that was ready and let go last at this time
  uint64_t steps_ = 0;
  int64_t end_ns_ = virtual_time::never_ns;
  std::multimap<int64_t, uint32_t> kills_;    ///< ranks of programs, by when
  int64_t stop_ns_ = virtual_time::never_ns;  ///< time stands then, until it is resumed
  std::string stop_topic_;                    ///< or when something is published; empty: none
  uint64_t published_before_ = 0;
  bool has_begun_ = false;
  bool is_frozen_ = false;  ///< the end of the duration was reached
  bool is_held_ = false;    ///< at the request of the user
  bool is_single_ = false;  ///< time stands after its next jump
  bool is_over_ = false;
};

}  // namespace manycore
