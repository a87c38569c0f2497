// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <cstdint>

#include "child.hpp"

/// For roles: what follows can be stepped through, up to finish_steps().
void begin_steps();
void finish_steps();

/// A process whose main thread does one instruction after the other, as far as the test lets it;
/// its other threads run freely. Its role calls begin_steps() and finish_steps(). The test shares
/// one CPU with it meanwhile: two that wake each other over CPUs take ten times as long a step.
class SteppedChild : public Child {
public:
  /// Returns once begin_steps() was reached.
  SteppedChild(const std::string & role, const Arguments & arguments);

  SteppedChild(const SteppedChild &) = delete;
  SteppedChild & operator=(const SteppedChild &) = delete;
  ~SteppedChild();

  /// Does so many instructions, or fewer where finish_steps() comes first; how many it did.
  uint64_t step(uint64_t instructions);

  /// Runs to the next entry into a system call, or the next return from one.
  void run_to_system_call();

  /// True once finish_steps() was reached.
  bool finished() const noexcept { return finished_; }

  /// Ends the main thread where it stands, as in a kill that its other threads have not met yet:
  /// these live on, and steps are over.
  void end_main_thread();

private:
  void resume(int request);

  cpu_set_t cpus_;  ///< of the test
  bool finished_ = false;
};
