// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/membership.hpp"

#include "platform/error.hpp"

namespace manycore {

void Membership::refuse() const {
  throw Error(
    ErrorCode::system,
    is_inherited()
      ? "this context, node, publisher, subscription, service or client belongs to the parent of "
        "this process and cannot be used after fork(); initialize a new context in the child"
      : "this process is no member of its platform any more: it was removed as dead, or the "
        "platform's memory is damaged; start it again");
}

}  // namespace manycore
