// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "rmw/context/context.hpp"
#include "rmw/context/guard_condition.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// A node: an entry in the registry and a guard condition for graph changes.
class Node {
public:
  /// Throws manycore::Error.
  Node(rmw_context_t & context, const char * name, const char * ns);
  ~Node();
  Node(const Node &) = delete;
  Node & operator=(const Node &) = delete;

  static Node & of(const rmw_node_t * handle) { return *static_cast<Node *>(handle->data); }

  rmw_node_t handle{};

  manycore::Process & process() const noexcept { return *context_.process; }
  const std::shared_ptr<manycore::Process> & shared_process() const noexcept {
    return context_.process;
  }
  CallbackThread & callback_thread() const noexcept { return context_.callback_thread; }
  /// Handle of the node in the registry.
  uint32_t registered() const noexcept { return registered_; }
  const GuardCondition & graph_changed() const noexcept { return graph_changed_; }

private:
  rmw_context_impl_s & context_;
  const std::string name_;
  const std::string ns_;
  GuardCondition graph_changed_;
  const uint32_t registered_;
};

}  // namespace rmw_manycore
