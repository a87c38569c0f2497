// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore {

/// Throws Error{no_space} naming the sessions when the publisher's cluster has `max_sessions` to
/// others, or the receiver `max_sessions` from others. The caller holds the registry lock.
void require_free_session(Registry & registry, const EndpointEntry & publisher, uint32_t receiver);

}  // namespace manycore
