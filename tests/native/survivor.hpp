// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <memory>

#include "platform_of_test.hpp"
#include "waiting.hpp"

/// A process of a platform, beside which others die.
struct Survivor {
  TestPlatform platform;
  std::shared_ptr<manycore::Process> process = platform.join(1);
  Inspection inspection{platform};
  pid_t receive_thread = platform.receive_thread(1);

  /// `left`: closed endpoints that something still keeps from being freed.
  void wait_until_alone(uint32_t left = 0) {
    wait_until("the dead are gone from the registry", [&] {
      return inspection.live_processes() == 1 && process->graph().nodes().empty();
    });
    inspection.wait_until_swept(left);
  }
};
