// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/carrier.hpp"

#include "transport/transfer/async_carrier.hpp"
#include "transport/transfer/message_carrier.hpp"
#include "transport/transfer/session_carrier.hpp"

namespace manycore {

std::unique_ptr<Carrier> make_carrier(
  const PlatformPaths & paths, const Cluster & own, const TransferSettings & settings) {
  switch (settings.kind) {
    case Transfer::message:
      return std::make_unique<MessageCarrier>(paths, settings);
    case Transfer::session:
      return std::make_unique<SessionCarrier>(paths, own.id());
    case Transfer::async:
      return std::make_unique<AsyncCarrier>();
    case Transfer::dsm:
      break;
  }
  return nullptr;
}

}  // namespace manycore
