// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/publisher.hpp"
#include "virtual_time/door.hpp"

using rmw_manycore::Publisher;

namespace {

void trace_publish(const rmw_publisher_t * publisher, const void * message, int64_t now_ns) {
  if (const auto publish = rmw_manycore::tracepoints().publish) {
    publish(publisher, message, now_ns);
  }
}

}  // namespace

rmw_ret_t rmw_publish(
  const rmw_publisher_t * publisher, const void * ros_message, rmw_publisher_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);
  MANYCORE_CHECK_ARGUMENT(ros_message);

  // Implementation: serializes directly into the topic DSM
  return rmw_manycore::guarded([&] {
    Publisher & sender = Publisher::of(publisher);
    const int64_t now_ns = manycore::publish_now_ns(sender.outbox().slot());
    trace_publish(publisher, ros_message, now_ns);
    manycore::Draft draft = sender.outbox().draft(sender.cdr().size_bound(ros_message));
    const size_t size = sender.cdr().serialize(ros_message, draft.data(), draft.capacity());
    sender.outbox().publish(std::move(draft), size, now_ns);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_publish_serialized_message(
  const rmw_publisher_t * publisher, const rmw_serialized_message_t * serialized_message,
  rmw_publisher_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(publisher);
  MANYCORE_CHECK_ARGUMENT(serialized_message);

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::Outbox & outbox = Publisher::of(publisher).outbox();
    const int64_t now_ns = manycore::publish_now_ns(outbox.slot());
    trace_publish(publisher, serialized_message, now_ns);
    const size_t size = serialized_message->buffer_length;
    manycore::Draft draft = outbox.draft(size);
    if (size != 0) {
      std::memcpy(draft.data(), serialized_message->buffer, size);
    }
    outbox.publish(std::move(draft), size, now_ns);
    return RMW_RET_OK;
  });
}
