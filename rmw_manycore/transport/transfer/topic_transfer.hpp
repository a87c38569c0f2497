// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/registry_layout.hpp"

namespace manycore {

/// How an endpoint's topic is transferred; `configured` is its line of the topic table, or nullptr.
/// Throws Error{unsupported} for a publisher whose QoS a transfer cannot keep.
Transfer transfer_of(const TopicEntry * configured, const EndpointSpec & spec, EndpointKind kind);

}  // namespace manycore
