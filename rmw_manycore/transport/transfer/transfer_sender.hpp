// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "transport/registry/registry.hpp"
#include "transport/transfer/carrier.hpp"

namespace manycore {

/// Hands the records of one publisher over to clusters that have subscriptions; where the topic is
/// not transferred, the announcement is all that is sent. One thread at a time, in the publisher's
/// phase (see Writing). See docs/design/transfers.md.
class TransferSender {
public:
  /// What a synchronous publish waits for at most, in all.
  static constexpr int64_t max_blocking_ns = 100'000'000;

  /// Throws Error{system}.
  TransferSender(Registry & registry, Cluster & own, EndpointEntry & publisher);

  /// False if the subscriptions there need a resync. Then the record arrived without an
  /// announcement, was given up, or was dropped with no record under way that makes them look.
  bool hand_over(const EmcosMessage & announcement, const Cluster & receiver) noexcept {
    return carrier_ == nullptr ? receiver.send(announcement) : transfer(announcement, receiver);
  }

  /// Throws Error{timeout} if a synchronous record was not received in time; the text says whether
  /// it may still arrive.
  void require_received() {
    if (late_.cluster != 0) {
      throw_late();
    }
  }

private:
  /// A cluster that has not confirmed the record in time.
  struct Late {
    uint32_t cluster = 0;
    bool may_arrive = false;
  };

  TransferSender(
    Registry & registry, Cluster & own, EndpointEntry & publisher,
    const TransferSettings & settings);
  bool transfer(const EmcosMessage & announcement, const Cluster & receiver) noexcept;
  void begin(uint64_t number) noexcept;
  Carried carry(
    const EmcosMessage & announcement, const Landing & landing, const Cluster & receiver) noexcept;
  /// False when a mover was killed meanwhile that may have received the record.
  bool note_handed(
    LandingHeader & landing, const std::atomic<uint64_t> & successors, uint64_t before) noexcept;
  void note_dropped(uint32_t cluster) noexcept;
  void note_late(const Late & late) noexcept;
  [[noreturn]] void throw_late();
  bool is_told_of_drop(const LandingHeader & landing, uint32_t cluster) noexcept;
  /// True when the mover gave it up before `decided` was stored: readers looked too early.
  bool is_given_up(const Landing & landing) const noexcept;

  Registry & registry_;
  Cluster & own_;
  EndpointEntry & publisher_;
  TopicDsmHeader & dsm_;
  std::unique_ptr<Carrier> carrier_;  ///< nullptr: the topic is not transferred
  const bool is_synchronous_;
  uint64_t number_ = 0;    ///< of the record that is being handed over, or was last
  int64_t until_ns_ = 0;   ///< CLOCK_MONOTONIC, of that record
  Late late_;              ///< one to which that record was not handed over comes first
  uint64_t dropping_ = 0;  ///< bit c - 1: cluster c was not given the record before
};

}  // namespace manycore
