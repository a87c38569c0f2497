// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "rmw/events/callback_thread.hpp"
#include "rmw/init.h"
#include "transport/process.hpp"

/// State of a context. rmw prescribes the type's name and its global namespace.
struct rmw_context_impl_s {
  explicit rmw_context_impl_s(std::shared_ptr<manycore::Process> joined)
  : process(std::move(joined)), callback_thread(process->waiters()) {}

  const std::shared_ptr<manycore::Process> process;
  rmw_manycore::CallbackThread callback_thread;
  std::atomic<size_t> node_count{0};
  /// Shared with the context's wait sets, which may outlive it.
  const std::shared_ptr<std::atomic<bool>> is_shutdown = std::make_shared<std::atomic<bool>>(false);
};
