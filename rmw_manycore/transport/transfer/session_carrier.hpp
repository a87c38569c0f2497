// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "platform/pipe.hpp"
#include "transport/transfer/carrier.hpp"

namespace manycore {

/// Asks the copying thread of the publisher's cluster to move the record: from its place in the
/// topic DSM to the same place in the landing, the other buffer of the pair.
class SessionCarrier final : public Carrier {
public:
  SessionCarrier(const PlatformPaths & paths, uint32_t own)
  : requests_(Pipe::open(paths.session_pipe(own))) {}

  Carried carry(
    const Parcel & parcel, const Landing &, const Cluster & receiver) noexcept override {
    CopyRequest request{};
    request.announcement = parcel.announcement;
    request.place = parcel.place;
    request.to_cluster = receiver.id();
    return requests_.try_send(&request, sizeof request) ? Carried::handed : Carried::dropped;
  }

private:
  Pipe requests_;
};

}  // namespace manycore
