// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "transport/layout/endpoint.hpp"
#include "transport/publisher/draft.hpp"

namespace manycore {

/// The writing role of one topic DSM. Thread-safe. Destroying it leaves what its readers have not
/// yet taken in place until they have.
class Publisher {
public:
  struct Impl;
  explicit Publisher(std::unique_ptr<Impl> impl);
  ~Publisher();

  const Gid & gid() const noexcept;
  const Qos & qos() const noexcept;

  /// Step 1 of Fig. 4, first half: room for `size_bytes` in the topic DSM, to serialize into.
  /// Throws Error{too_large} (text names the size needed), Error{no_space}, or Error{timeout} when
  /// RELIABLE + KEEP_ALL readers left no room within `max_blocking_ns`.
  Draft draft(size_t size_bytes);

  /// Step 1, second half: makes the first `size_bytes` of the draft a record and notifies readers.
  /// `source_timestamp_ns` is CLOCK_REALTIME. Returns the publication sequence number (from 1).
  /// With a correlation whose client is set and role reply, only that client receives it.
  uint64_t publish(
    Draft && draft, size_t size_bytes, int64_t source_timestamp_ns,
    const Correlation & correlation = {});

  /// For MANUAL_BY_TOPIC liveliness, which publish() asserts as well; else nothing to do.
  void assert_liveliness();

  MatchedCount matched() const;
  IncompatibleCount incompatible() const;
  uint64_t incompatible_types() const noexcept;
  TimedCount deadline_missed() const noexcept;
  TimedCount liveliness_lost() const noexcept;

private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace manycore
