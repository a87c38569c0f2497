// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "transport/transfer/carrier.hpp"

namespace manycore {

/// One-sided: the publisher puts the record into the receiving cluster itself; no thread there
/// takes part. The segment of a message is its part of the landing, made and freed with the record.
class AsyncCarrier final : public Carrier {
public:
  Carried carry(
    const Parcel & parcel, const Landing & landing, const Cluster & receiver) noexcept override {
    uint8_t * const segment = landing.find(parcel.place);
    if (segment == nullptr) {
      return Carried::dropped;
    }
    std::memcpy(segment, parcel.data, parcel.place.size_bytes);
    landing.arrive(parcel.announcement.number);
    return receiver.send(parcel.announcement) ? Carried::handed : Carried::unannounced;
  }
};

}  // namespace manycore
