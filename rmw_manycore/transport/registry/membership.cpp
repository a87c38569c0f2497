// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/membership.hpp"

#include "platform/error.hpp"

namespace manycore {

void Membership::refuse() const {
  if (is_inherited()) {
    throw Error(
      ErrorCode::system,
      "this context, node, publisher, subscription, service or client belongs to the parent of "
      "this process and cannot be used after fork(); initialize a new context in the child");
  }
  if (is_cut_off()) {
    throw Error(
      ErrorCode::system,
      "the platform's files were removed while it ran (systemd-logind does so at logout, if "
      "RemoveIPC is on: see 'manycore doctor'); restart this process");
  }
  throw Error(
    ErrorCode::system,
    "this process is no longer a member of its platform: it was removed as dead, or the "
    "platform's memory is damaged; restart it");
}

}  // namespace manycore
