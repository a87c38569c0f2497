// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rmw_manycore {

/// The rmw's tracepoints of libtracetools (LTTng), with the fields that rmw_fastrtps_cpp gives, for
/// ros2_tracing and CARET. Taken from the library that the process has loaded already, as rcl does:
/// this one needs none. Null where there is none.
struct Tracepoints {
  void (*publisher_init)(const void * publisher, const uint8_t * gid);
  void (*publish)(const void * publisher, const void * message, int64_t timestamp_ns);
  void (*subscription_init)(const void * subscription, const uint8_t * gid);
  /// `source_timestamp_ns`: 0 where the caller did not ask for it.
  void (*take)(
    const void * subscription, const void * message, int64_t source_timestamp_ns, bool taken);
};

/// Found at the first call.
const Tracepoints & tracepoints() noexcept;

}  // namespace rmw_manycore
