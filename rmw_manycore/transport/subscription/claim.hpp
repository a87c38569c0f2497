// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "transport/layout/endpoint.hpp"

namespace manycore {

class Source;
class Subscription;

/// Metadata of a claimed record.
struct RecordInfo {
  int64_t source_timestamp_ns = 0;    ///< CLOCK_REALTIME at publish
  int64_t received_timestamp_ns = 0;  ///< CLOCK_REALTIME at claim
  uint64_t publication_sequence_number = 0;
  uint64_t reception_sequence_number = 0;
  Gid publisher{};
  Correlation correlation;
  bool from_this_process = false;
};

/// A record that this subscription is reading: claim, deserialize, release (by destruction).
/// The publisher cannot recycle it meanwhile. Holds the subscription's mutex; stays in one thread.
/// In a child of fork() it ends without effect.
class Claim {
public:
  Claim(Claim && other) noexcept = default;
  Claim & operator=(Claim &&) = delete;
  ~Claim();

  const uint8_t * data() const noexcept { return data_; }
  size_t size() const noexcept { return size_; }
  const RecordInfo & info() const noexcept { return info_; }

  /// Counts the record as lost instead of taken: its bytes are no message.
  void reject() noexcept;

private:
  friend class Subscription;
  Claim(
    Subscription & subscription, std::unique_lock<std::mutex> && lock, Source & source,
    uint64_t number) noexcept;

  Subscription & subscription_;
  std::unique_lock<std::mutex> lock_;  ///< not owned once moved from
  Source & source_;
  uint64_t number_;
  const uint8_t * data_ = nullptr;
  size_t size_ = 0;
  RecordInfo info_;
};

}  // namespace manycore
