// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/transfer_pipes.hpp"

namespace manycore::transfer_pipes {
namespace {

/// Calls `visit(const TransferSettings &)` for each line of the topic table.
template<typename Visit>
void for_each_topic(const Registry & registry, Visit visit) {
  for (uint32_t i = 0; i < registry.header().topic_count && i < topic_capacity; ++i) {
    visit(registry.topic(i).transfer);
  }
}

}  // namespace

std::vector<uint32_t> priorities(const Registry & registry) {
  uint32_t used = 0;
  for_each_topic(registry, [&](const TransferSettings & settings) {
    if (settings.kind == Transfer::message) {
      used |= uint32_t{1} << (settings.priority % transfer_priorities);
    }
  });
  std::vector<uint32_t> highest_first;
  for (uint32_t priority = transfer_priorities; priority-- != 0;) {
    if ((used >> priority & 1) != 0) {
      highest_first.push_back(priority);
    }
  }
  return highest_first;
}

bool has_sessions(const Registry & registry) noexcept {
  bool found = false;
  for_each_topic(registry, [&](const TransferSettings & settings) {
    found = found || settings.kind == Transfer::session;
  });
  return found;
}

void create(const Registry & registry, const PlatformPaths & paths, uint32_t cluster) {
  for (const uint32_t priority : priorities(registry)) {
    Pipe::create(paths.data_pipe(cluster, priority));
  }
  if (has_sessions(registry)) {
    Pipe::create(paths.session_pipe(cluster));
  }
}

}  // namespace manycore::transfer_pipes
