// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <utility>

#include "transport/process.hpp"

namespace manycore::python {

/// A record in its place in the topic DSM, until released.
class BoundClaim {
public:
  explicit BoundClaim(Claim && claim) : claim_(std::move(claim)) {}

  uintptr_t address() const { return reinterpret_cast<uintptr_t>(held().data()); }
  size_t size() const { return held().size(); }
  nanobind::bytes data() const { return nanobind::bytes(held().data(), held().size()); }
  nanobind::bytes publisher() const;
  nanobind::bytes client() const;
  int64_t number() const { return held().info().correlation.number; }
  int64_t source_timestamp_ns() const { return held().info().source_timestamp_ns; }
  uint64_t sequence() const { return held().info().publication_sequence_number; }
  void release() { claim_.reset(); }

private:
  const Claim & held() const;

  std::optional<Claim> claim_;
};

/// A subscription and the membership it needs.
class BoundSubscription {
public:
  BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec);

  std::unique_ptr<BoundClaim> claim();
  /// For traces: what is claimed was published outside.
  void note_bridged();
  nanobind::bytes gid() const;
  uint64_t matched() const { return subscription_->matched().current; }
  uint64_t lost() const { return subscription_->lost(); }
  bool has_data() const { return subscription_->has_data(); }

private:
  std::shared_ptr<Process> process_;
  std::unique_ptr<Subscription> subscription_;
};

}  // namespace manycore::python
