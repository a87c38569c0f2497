// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace manycore {

/// Commands of the run to its timekeeper, one line each.
struct Command {
  enum class Kind {
    start,   ///< `start RANK PID NAME`: the program's process exists; time stands until it joined
    gone,    ///< `gone RANK`: the program has ended and is not started again
    later,   ///< `later RANK NS`: it does not run, and is to be started when NS have passed
    go,      ///< `go NS`: all programs were started; time ends after NS, unless that is 0
    kill,    ///< `kill RANK NS`: the program's processes are killed when NS have passed
    hold,    ///< `hold`: time stands
    resume,  ///< `resume NS TOPIC`: it goes on, for NS (0: without end; -1: to what is due next),
             ///< or until something is published on TOPIC, which may lack
    over,    ///< `over`, or the end of the input: from here on time is the wall clock's
  };
  Kind kind;
  uint32_t rank = 0;
  int32_t pid = 0;
  int64_t duration_ns = 0;
  std::string name{};  ///< or the topic
};

/// The lines of standard input. Never blocks.
class CommandInput {
public:
  /// Makes standard input non-blocking.
  CommandInput();
  std::vector<Command> take();

private:
  std::string unfinished_;
};

}  // namespace manycore
