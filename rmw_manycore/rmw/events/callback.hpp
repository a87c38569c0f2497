// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "rmw/events/reporter.hpp"

namespace rmw_manycore {

class CallbackThread;

/// The callback of an entity, which the user may set.
class Callback {
public:
  Callback(CallbackThread & thread, Reporter::Source source)
  : thread_(thread), reporter_(std::make_shared<Reporter>(std::move(source))) {}
  ~Callback() { clear(); }
  Callback(const Callback &) = delete;
  Callback & operator=(const Callback &) = delete;

  /// Sets, replaces or (nullptr) clears the function. Earlier arrivals that are neither reported
  /// nor taken are reported at once, from the calling thread, unless another thread is calling
  /// functions: then by the thread that calls callbacks. The function may destroy this object.
  /// Waits until the former function does not run, unless called from it. No effect in a child of
  /// fork().
  void set(rmw_event_callback_t function, const void * user_data);
  /// False while the function is still to be called, or running, for some of the first `count`
  /// arrivals. True if none is set.
  bool has_called_for(uint64_t count) const noexcept;

private:
  void clear() noexcept;

  CallbackThread & thread_;
  const std::shared_ptr<Reporter> reporter_;
};

}  // namespace rmw_manycore
