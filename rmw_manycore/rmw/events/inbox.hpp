// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>

#include "rmw/events/callback.hpp"
#include "rmw/events/callback_thread.hpp"
#include "rmw/serialization/cdr.hpp"
#include "transport/subscription/subscription.hpp"

namespace rmw_manycore {

/// Receiving side of a subscription, service or client, and its on-arrival callback.
class Inbox {
public:
  Inbox(
    std::unique_ptr<manycore::Subscription> subscription, MessageTopic topic,
    CallbackThread & thread)
  : subscription_(std::move(subscription)),
    watched_(thread.waiters(), subscription_->watchers()),
    on_arrival_(
      thread,
      {watched_.watchers(), [this] { return Reporter::Arrivals{subscription_->arrivals()}; },
       [this] { return unread(); }, std::move(topic),
       static_cast<uint32_t>(manycore::endpoint_in(subscription_->gid())),
       [this] { return known(); }}) {
    watched_.watchers().reset();  // waiting threads add their own words
  }

  const manycore::Subscription & transport() const noexcept { return *subscription_; }
  const manycore::Watched & watched() const noexcept { return watched_; }
  Callback & on_arrival() noexcept { return on_arrival_; }
  bool has_data() const noexcept { return subscription_->has_data(); }

  std::optional<manycore::Claim> claim() { return subscription_->claim(); }
  /// Calls `read(claim)` for the next message, directly in its topic DSM; nothing if there is none.
  /// Malformed messages, for which it throws, are dropped and counted as lost, so bytes from the
  /// network cannot end a node.
  template<typename Read>
  std::optional<manycore::RecordInfo> take(const Read & read) {
    while (auto claim = subscription_->claim()) {
      try {
        read(*claim);
        return claim->info();
      } catch (const std::exception & error) {
        claim->reject();
        warn_of_drop(claim->size(), error.what());
      }
    }
    return std::nullopt;
  }
  /// Takes the next message that `cdr` can deserialize.
  std::optional<manycore::RecordInfo> take(const Cdr & cdr, void * message) {
    return take(
      [&](const manycore::Claim & claim) { cdr.deserialize(claim.data(), claim.size(), message); });
  }

private:
  /// Logs at most once per second.
  void warn_of_drop(size_t size, const char * reason) noexcept;

  /// The count is read first: a resync that is requested later wakes the callback thread.
  Reporter::Known known() const noexcept {
    const uint64_t count = subscription_->announced();
    return {count, !subscription_->has_to_resync()};
  }
  /// Arrivals not claimed yet; an estimate while other threads push or claim.
  uint64_t unread() const;

  std::unique_ptr<manycore::Subscription> subscription_;
  manycore::Watched watched_;
  Callback on_arrival_;
  std::atomic<int64_t> next_warning_ns_{0};  ///< CLOCK_MONOTONIC
};

}  // namespace rmw_manycore
