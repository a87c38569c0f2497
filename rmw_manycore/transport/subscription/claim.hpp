// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "platform/handover_mutex.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/subscription/hold.hpp"

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

/// A record that this subscription is reading: claim, deserialize, release (by destruction). The
/// publisher cannot recycle the record meanwhile. Holds the subscription's mutex, so a
/// subscription has one claim at a time; any thread may destroy it. In a child of fork() the
/// destructor has no effect.
class Claim {
public:
  Claim(Claim && other) noexcept = default;
  Claim & operator=(Claim &&) = delete;
  ~Claim();

  const uint8_t * data() const noexcept { return data_; }
  size_t size() const noexcept { return size_; }
  const RecordInfo & info() const noexcept { return info_; }

  /// How the topic's records are to be read.
  ZeroCopy zero_copy() const noexcept;
  /// Keeps the bytes in place after this claim. Nothing where the record lies in the ring, as small
  /// ones do, or where too many are held: then copy.
  std::optional<Hold> hold() noexcept;
  /// After hold() returned nothing: a line about the limit that held memory has reached, and what
  /// to do. Empty where the record cannot be held at all.
  std::string reached_limit() const;
  /// Counts the record as one that its reader does not copy.
  void count_in_place() noexcept;

  /// Counts the record as lost instead of taken, because its bytes could not be deserialized.
  void reject() noexcept;

private:
  friend class Subscription;
  Claim(
    Subscription & subscription, std::unique_lock<HandoverMutex> && lock, Source & source,
    uint64_t number) noexcept;

  Subscription & subscription_;
  std::unique_lock<HandoverMutex> lock_;  ///< not owned after a move
  Source & source_;
  uint64_t number_;
  const uint8_t * data_ = nullptr;
  size_t size_ = 0;
  RecordInfo info_;
  ChunkHead * chunk_ = nullptr;
  bool is_for_one_reader_ = false;
};

}  // namespace manycore
