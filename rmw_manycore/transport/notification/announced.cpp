// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/announced.hpp"

namespace manycore {
namespace {

/// Checked before the header is read, which may be freed. Dekker with the sweeper: the phase is
/// stored before the state is loaded.
bool is_publisher_there(Registry & registry, const EmcosMessage & message) noexcept {
  if (message.endpoint >= registry.endpoints().high_water()) {
    return false;
  }
  const Slot & publisher = registry.endpoints()[message.endpoint].slot;
  return has_memory(publisher.state.load(std::memory_order_seq_cst)) &&
         publisher.incarnation.load(std::memory_order_seq_cst) == message.incarnation;
}

}  // namespace

Announced Announced::find(Registry & registry, const EmcosMessage & message) noexcept {
  const Cluster * const source = registry.clusters().find(message.topic_dsm.cluster());
  auto * const dsm =
    source == nullptr ? nullptr : source->find<TopicDsmHeader>(message.topic_dsm.offset());
  const bool is_current = dsm != nullptr && is_publisher_there(registry, message) &&
                          dsm->magic.load(std::memory_order_relaxed) == topic_dsm_magic &&
                          dsm->endpoint.load(std::memory_order_relaxed) == message.endpoint &&
                          dsm->incarnation.load(std::memory_order_relaxed) == message.incarnation;
  return is_current ? Announced{source, dsm} : Announced{};
}

}  // namespace manycore
