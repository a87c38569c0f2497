// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <cstdint>

#include "child.hpp"

/// For roles: everything up to finish_steps() can be single-stepped.
void begin_steps();
void finish_steps();

/// A process whose main thread executes one instruction at a time, as the test permits; its other
/// threads run freely. Its role calls begin_steps() and finish_steps(). The test shares one CPU
/// with it: waking each other across CPUs makes each step ten times slower.
class SteppedChild : public Child {
public:
  /// Returns once begin_steps() is reached.
  SteppedChild(const std::string & role, const Arguments & arguments);

  SteppedChild(const SteppedChild &) = delete;
  SteppedChild & operator=(const SteppedChild &) = delete;
  ~SteppedChild();

  /// Executes this many instructions, or fewer if finish_steps() is reached; returns how many.
  uint64_t step(uint64_t instructions);

  /// Runs to the next entry into or return from a system call.
  void run_to_system_call();

  /// True once finish_steps() is reached.
  bool finished() const noexcept { return finished_; }

  /// Ends the main thread where it is, as a kill does that has not reached the other threads yet:
  /// they live on, and stepping is over.
  void end_main_thread();

private:
  void resume(int request);

  cpu_set_t cpus_;  ///< of the test
  bool finished_ = false;
};
