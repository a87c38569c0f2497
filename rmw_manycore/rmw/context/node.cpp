// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/context/node.hpp"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/names.hpp"
#include "rmw/rmw.h"

namespace rmw_manycore {

Node::Node(rmw_context_t & context, const char * name, const char * ns)
: context_(*context.impl),
  name_(name),
  ns_(ns),
  graph_changed_(context, GuardCondition::Source::graph),
  registered_(process().add_node(name_, ns_, context.options.enclave)) {
  ++context_.node_count;
  handle.implementation_identifier = identifier;
  handle.data = this;
  handle.name = name_.c_str();
  handle.namespace_ = ns_.c_str();
  handle.context = &context;
}

Node::~Node() {
  process().remove_node(registered_);
  --context_.node_count;
}

}  // namespace rmw_manycore

using rmw_manycore::Node;

rmw_node_t * rmw_create_node(rmw_context_t * context, const char * name, const char * namespace_) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(context->impl, "expected initialized context", return nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(name, nullptr);
  RMW_CHECK_ARGUMENT_FOR_NULL(namespace_, nullptr);
  if (*context->impl->is_shutdown) {
    RMW_SET_ERROR_MSG("context has been shutdown");
    return nullptr;
  }

  // Implementation
  return rmw_manycore::guarded_handle([&] {
    rmw_manycore::check_node_name(name);
    rmw_manycore::check_namespace(namespace_);
    return &(new Node(*context, name, namespace_))->handle;
  });
}

rmw_ret_t rmw_destroy_node(rmw_node_t * node) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);

  // Implementation
  delete &Node::of(node);
  return RMW_RET_OK;
}

const rmw_guard_condition_t * rmw_node_get_graph_guard_condition(const rmw_node_t * node) {
  // Invariants
  MANYCORE_CHECK_HANDLE_OR_NULL(node);

  // Implementation
  return &Node::of(node).graph_changed().handle;
}
