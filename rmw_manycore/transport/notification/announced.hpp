// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// The topic DSM that a `publish` message names, and its cluster. Null unless the slot of the
/// message's publisher still owns it. The caller makes its phase odd before it calls find(), and
/// may follow the references as long as it stays odd; or it holds the registry lock.
struct Announced {
  const Cluster * source = nullptr;
  TopicDsmHeader * dsm = nullptr;

  static Announced find(Registry & registry, const EmcosMessage & message) noexcept;
  explicit operator bool() const noexcept { return dsm != nullptr; }
};

}  // namespace manycore
