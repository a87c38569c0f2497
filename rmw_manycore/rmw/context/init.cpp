// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/init.h"

#include <cstdlib>
#include <memory>
#include <string>

#include "platform/error.hpp"
#include "platform/process_identity.hpp"
#include "rcutils/logging_macros.h"
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/context/context.hpp"
#include "rmw/domain_id.h"

namespace rmw_manycore {
namespace {

/// DDS security enclaves are not supported; file permissions keep a platform private to its user.
void refuse_security(const rmw_security_options_t & security) {
  if (security.enforce_security == RMW_SECURITY_ENFORCEMENT_ENFORCE) {
    throw manycore::Error(
      manycore::ErrorCode::unsupported,
      "rmw_manycore does not support DDS security: unset ROS_SECURITY_STRATEGY=Enforce or "
      "ROS_SECURITY_ENABLE; file permissions keep a platform private to its user");
  }
}

/// Name of a platform that no other process joins: a pid alone is unique within one PID namespace
/// (container) only, and is reused.
std::string private_platform(size_t domain_id) {
  const auto own = manycore::ProcessIdentity::own();
  return "private-" + std::to_string(domain_id) + "-" + std::to_string(own.pid) + "-" +
         std::to_string(own.start_time) + "-" + std::to_string(own.pid_namespace);
}

/// Warns that a context which was given another domain than ROS_DOMAIN_ID is not on the named
/// platform: its author may have expected it there.
void warn_if_beside(const manycore::Placement & placement, size_t domain_id) {
  const char * const named = std::getenv("MANYCORE_PLATFORM");
  if (named == nullptr || *named == 0 || placement.platform == named) {
    return;
  }
  const char * const own = std::getenv("ROS_DOMAIN_ID");
  RCUTILS_LOG_WARN_NAMED(
    identifier,
    "MANYCORE_PLATFORM='%s' is the platform of domain %s: this context of domain %zu joins "
    "platform %s; set ROS_DOMAIN_ID=%zu if it is meant for '%s'",
    named, own == nullptr || *own == 0 ? "0" : own, domain_id, placement.platform.c_str(),
    domain_id, named);
}

/// A platform is local to the machine, so all discovery ranges except OFF are equivalent.
manycore::Placement placement_of(const rmw_init_options_t & options, size_t domain_id) {
  const rmw_discovery_options_t & discovery = options.discovery_options;
  manycore::Placement placement = manycore::Placement::from_environment(domain_id);
  if (discovery.automatic_discovery_range == RMW_AUTOMATIC_DISCOVERY_RANGE_OFF) {
    placement.platform = private_platform(domain_id);
    placement.cluster = 1;  // cluster and core were those of the shared platform
    placement.core.reset();
  } else {
    warn_if_beside(placement, domain_id);
  }
  if (discovery.static_peers_count != 0) {
    RCUTILS_LOG_WARN_NAMED(
      identifier,
      "static discovery peers are ignored: rmw_manycore uses no network; "
      "a bridge connects topics with other machines");
  }
  return placement;
}

/// Warns that processes share a core: started by hand, one may have been meant for another. A
/// mapfile that allows it sets MANYCORE_SHARED_CORE.
void warn_if_shared(const manycore::Process & process) {
  const char * const is_meant = std::getenv("MANYCORE_SHARED_CORE");
  if (is_meant != nullptr && *is_meant != 0) {
    return;
  }
  for (const manycore::ProcessInfo & other : process.beside()) {
    RCUTILS_LOG_WARN_NAMED(
      identifier,
      "cluster %u core %d is also that of '%s' (pid %d): set another MANYCORE_CORE, or "
      "MANYCORE_SHARED_CORE=1 if this is meant",
      other.cluster, other.core, other.label.c_str(), other.pid);
  }
}

}  // namespace
}  // namespace rmw_manycore

rmw_ret_t rmw_init(const rmw_init_options_t * options, rmw_context_t * context) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(options);
  MANYCORE_CHECK_ARGUMENT(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    options->implementation_identifier, "expected initialized init options",
    return RMW_RET_INVALID_ARGUMENT);
  MANYCORE_CHECK_HANDLE(options);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    options->enclave, "expected non-null enclave", return RMW_RET_INVALID_ARGUMENT);
  if (context->implementation_identifier != nullptr) {
    RMW_SET_ERROR_MSG("expected a zero-initialized context");
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::refuse_security(options->security_options);
    rmw_context_t created = rmw_get_zero_initialized_context();
    created.instance_id = options->instance_id;
    created.implementation_identifier = rmw_manycore::identifier;
    created.actual_domain_id = options->domain_id == RMW_DEFAULT_DOMAIN_ID ? 0 : options->domain_id;
    auto impl = std::make_unique<rmw_context_impl_s>(
      manycore::Process::join(rmw_manycore::placement_of(*options, created.actual_domain_id)));
    rmw_manycore::check(rmw_init_options_copy(options, &created.options));
    rmw_manycore::warn_if_shared(*impl->process);
    impl->process->begin_context();
    created.impl = impl.release();
    *context = created;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_shutdown(rmw_context_t * context) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    context->impl, "expected initialized context", return RMW_RET_INVALID_ARGUMENT);
  MANYCORE_CHECK_HANDLE(context);

  // Implementation
  const bool was_shutdown = context->impl->is_shutdown->exchange(true);
  if (!context->impl->process->is_inherited()) {
    if (!was_shutdown) {
      context->impl->process->end_context();
    }
    context->impl->process->waiters().notify_all();
  }
  context->impl->callback_thread.stop();
  return RMW_RET_OK;
}

rmw_ret_t rmw_context_fini(rmw_context_t * context) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(context);
  RMW_CHECK_FOR_NULL_WITH_MSG(
    context->impl, "expected initialized context", return RMW_RET_INVALID_ARGUMENT);
  MANYCORE_CHECK_HANDLE(context);
  if (!*context->impl->is_shutdown) {
    RMW_SET_ERROR_MSG("context has not been shutdown");
    return RMW_RET_INVALID_ARGUMENT;
  }
  if (context->impl->node_count != 0) {
    RMW_SET_ERROR_MSG("finalizing a context with active nodes");
    return RMW_RET_ERROR;
  }

  // Implementation
  const rmw_ret_t result = rmw_init_options_fini(&context->options);
  if (!context->impl->process->is_inherited()) {
    delete context->impl;
  }  // else it is left to the parent, which owns the threads
  *context = rmw_get_zero_initialized_context();
  return result;
}
