// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace manycore {

/// The model of the platform, which knows how long callbacks take there: another process
/// (rmw_manycore_py/prediction/live), asked in lines over two pipes. Throws Error if it has ended.
class PlatformModel {
public:
  /// Takes ownership of two file descriptors.
  PlatformModel(int to, int from);

  /// A thread that is done with a step.
  struct Thread {
    uint32_t seat;
    int32_t tid;
  };
  /// All messages of a subscription are under way, or one has arrived.
  struct Passage {
    bool is_over;
    std::string topic;
    std::string node;
  };
  struct Answer {
    int64_t at_ns;  ///< since the begin of the run
    std::optional<Thread> done;
    bool is_waiting = false;  ///< for resume(): a thread is done, or a message has arrived
    std::vector<Passage> passages{};
  };

  /// Gives the next step of a thread, at the time of the last answer.
  void ask(const Thread & thread, const std::string & what);
  /// Lets time pass, `until_ns` at the latest, until a thread is done or a message arrives. The
  /// thread keeps its CPU if it is asked for again before resume().
  Answer advance(int64_t until_ns);
  void resume();

private:
  struct Close {
    void operator()(std::FILE * file) const noexcept { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  void tell(const std::string & line);
  std::string next_line();

  const File to_;
  const File from_;
};

}  // namespace manycore
