// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Replaces libtracetools' rmw tracepoints by LD_PRELOAD, and prints each call.
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

void ros_trace_rmw_publisher_init(const void * publisher, const uint8_t * gid) {
  fprintf(stderr, "publisher_init %p %d\n", publisher, gid[0] | gid[1] | gid[2]);
}

void ros_trace_rmw_publish(const void * publisher, const void * message, int64_t timestamp_ns) {
  fprintf(stderr, "publish %p %d %ld\n", publisher, message != NULL, (long)timestamp_ns);
}

void ros_trace_rmw_subscription_init(const void * subscription, const uint8_t * gid) {
  fprintf(stderr, "subscription_init %p %d\n", subscription, gid[0] | gid[1] | gid[2]);
}

void ros_trace_rmw_take(
  const void * subscription, const void * message, int64_t source_timestamp_ns, bool taken) {
  fprintf(
    stderr, "take %p %d %ld %d\n", subscription, message != NULL, (long)source_timestamp_ns, taken);
}

void ros_trace_rmw_client_init(const void * client, const uint8_t * gid) {
  fprintf(stderr, "client_init %p %d\n", client, gid[0] | gid[1] | gid[2]);
}

void ros_trace_rmw_send_request(const void * client, const void * request, int64_t number) {
  fprintf(stderr, "send_request %p %d %ld\n", client, request != NULL, (long)number);
}

void ros_trace_rmw_take_request(
  const void * service, const void * request, const uint8_t * gid, int64_t number, bool taken) {
  fprintf(
    stderr, "take_request %p %d %d %ld %d\n", service, request != NULL, gid[0] | gid[1] | gid[2],
    (long)number, taken);
}

void ros_trace_rmw_send_response(
  const void * service, const void * response, const uint8_t * gid, int64_t number,
  int64_t timestamp_ns) {
  fprintf(
    stderr, "send_response %p %d %d %ld %ld\n", service, response != NULL,
    gid[0] | gid[1] | gid[2], (long)number, (long)timestamp_ns);
}

void ros_trace_rmw_take_response(
  const void * client, const void * response, int64_t number, int64_t source_timestamp_ns,
  bool taken) {
  fprintf(
    stderr, "take_response %p %d %ld %ld %d\n", client, response != NULL, (long)number,
    (long)source_timestamp_ns, taken);
}
