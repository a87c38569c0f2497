// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "platform/pipe.hpp"
#include "transport/transfer/carrier.hpp"

namespace manycore {

/// Sends records as packets through the data pipe of the receiving cluster. Asynchronous: a full
/// pipe drops the record. Synchronous: waits for room, and for the record's arrival.
class MessageCarrier final : public Carrier {
public:
  MessageCarrier(const PlatformPaths & paths, const TransferSettings & settings)
  : paths_(paths), settings_(settings) {}

  Carried carry(
    const Parcel & parcel, const Landing & landing, const Cluster & receiver) noexcept override;

private:
  /// Nullptr when it cannot be opened.
  const Pipe * pipe_to(uint32_t cluster) noexcept;
  bool send(const Pipe & pipe, const Packet & packet, int64_t until_ns) const noexcept;

  const PlatformPaths & paths_;
  const TransferSettings settings_;
  std::array<std::optional<Pipe>, max_clusters> pipes_;
  Packet packet_{};
};

}  // namespace manycore
