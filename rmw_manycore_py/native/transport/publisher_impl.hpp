// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "transport/publisher.hpp"
#include "transport/topic_dsm_writer.hpp"

namespace manycore {

struct Publisher::Impl {
  Impl(Registry & registry_, uint32_t slot_)
  : registry(registry_),
    slot(slot_),
    entry(registry_.endpoints()[slot_]),
    cluster(registry_.clusters().at(entry.cluster)),
    writer(registry_, cluster, entry) {}

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Cluster & cluster;
  std::mutex mutex;  ///< held from draft() to publish()
  TopicDsmWriter writer;
  uint64_t published = 0;
};

}  // namespace manycore
