// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "rmw/events/callback_thread.hpp"
#include "transport/subscription.hpp"

namespace rmw_manycore {

/// The reading end of a subscription, service or client, and the callback for what arrives at it.
class Inbox {
public:
  Inbox(std::unique_ptr<manycore::Subscription> subscription, CallbackThread & thread)
  : subscription_(std::move(subscription)),
    on_arrival_(
      thread, [this] { return subscription_->arrivals(); }, [this] { return unread(); }) {}

  const manycore::Subscription & transport() const noexcept { return *subscription_; }
  /// Where who waits for arrivals sleeps.
  manycore::Waiter & waiter() const noexcept { return on_arrival_.waiter(); }
  Callback & on_arrival() noexcept { return on_arrival_; }
  bool has_data() const noexcept { return subscription_->has_data(); }

  std::optional<manycore::Claim> claim() { return subscription_->claim(); }

private:
  /// How many arrivals wait to be claimed. An estimate while others push or claim.
  uint64_t unread() const;

  std::unique_ptr<manycore::Subscription> subscription_;
  Callback on_arrival_;
};

}  // namespace rmw_manycore
