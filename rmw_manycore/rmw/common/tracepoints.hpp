// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rmw_manycore {

/// The rmw tracepoints of libtracetools (LTTng), with the same fields as in rmw_fastrtps_cpp, for
/// ros2_tracing and CARET. Resolved in the library that the process has already loaded for rcl, so
/// this library does not depend on it. Null if it is not loaded.
struct Tracepoints {
  void (*publisher_init)(const void * publisher, const uint8_t * gid);
  void (*publish)(const void * publisher, const void * message, int64_t timestamp_ns);
  void (*subscription_init)(const void * subscription, const uint8_t * gid);
  /// `source_timestamp_ns` is 0 if the caller did not ask for message info.
  void (*take)(
    const void * subscription, const void * message, int64_t source_timestamp_ns, bool taken);

  // Since Kilted. `client_gid` identifies the client in all of them.
  void (*client_init)(const void * client, const uint8_t * client_gid);
  void (*send_request)(const void * client, const void * request, int64_t number);
  void (*take_request)(
    const void * service, const void * request, const uint8_t * client_gid, int64_t number,
    bool taken);
  void (*send_response)(
    const void * service, const void * response, const uint8_t * client_gid, int64_t number,
    int64_t timestamp_ns);
  void (*take_response)(
    const void * client, const void * response, int64_t number, int64_t source_timestamp_ns,
    bool taken);
};

/// Resolved on the first call.
const Tracepoints & tracepoints() noexcept;

}  // namespace rmw_manycore
