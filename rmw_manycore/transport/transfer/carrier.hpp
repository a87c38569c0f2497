// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "transport/registry/registry.hpp"
#include "transport/transfer/landing.hpp"

namespace manycore {

/// A record on its way to one cluster.
struct Parcel {
  const EmcosMessage & announcement;
  RecordPlace place;
  const uint8_t * data;
  int64_t until_ns;  ///< CLOCK_MONOTONIC: a synchronous transfer gives up then
};

enum class Carried : uint8_t {
  handed,       ///< it is there, or a thread of the platform copies it
  unannounced,  ///< it is there, but the receive thread's pipe is full
  dropped,      ///< there was no room for it
  unconfirmed,  ///< synchronous: it was handed over, and has not arrived in time
};

/// One way of transferring records. One thread at a time; never waits but for `until_ns`.
class Carrier {
public:
  virtual ~Carrier() = default;
  virtual Carried carry(
    const Parcel & parcel, const Landing & landing, const Cluster & receiver) noexcept = 0;
};

/// `own`: the publisher's cluster.
std::unique_ptr<Carrier> make_carrier(
  const PlatformPaths & paths, const Cluster & own, const TransferSettings & settings);

}  // namespace manycore
