// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/error.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// One reader of the own topic DSM, resolved to addresses of this process.
struct Reader {
  SourceEntry * source = nullptr;
  SubscriptionHeader * subscription = nullptr;
  WakeWords * wake = nullptr;
  uint32_t cluster = 0;
  uint32_t endpoint = 0;
  uint32_t source_index = 0;
  uint32_t source_incarnation = 0;
  bool reliable = false;
  Gid gid{};

  bool active() const noexcept {
    return source->state.load(std::memory_order_acquire) == SourceState::active;
  }
};

/// A publisher's private copy of its reader table, renewed when the table changes. The addresses in
/// it are good while the publisher's phase is odd (see docs/design/topic_dsm.md, Freeing).
class ReaderList {
public:
  ReaderList(Registry & registry, Cluster & cluster, TopicDsmHeader & dsm) noexcept
  : registry_(registry), cluster_(cluster), dsm_(dsm) {}

  /// Renews the copy if the table changed. The load is seq_cst: it must not move before the
  /// caller's preceding seq_cst store of `phase`, `number` or `last`.
  void refresh() {
    if (dsm_.match_generation.load(std::memory_order_seq_cst) != seen_) {
      rebuild();
    }
  }

  const std::vector<Reader> & readers() const noexcept { return readers_; }

  /// Throws Error{system|permission|corrupt} naming the topic when a reader cannot be resolved.
  void require_all(const char * topic) const {
    if (unresolved_) {
      throw_unresolved(topic);
    }
  }

  /// True while some reader holds a claim on record `number`, or may: the claims of one that cannot
  /// be resolved are not to be seen.
  bool is_pinned(uint64_t number) const noexcept {
    if (unresolved_) {
      return true;
    }
    for (const Reader & reader : readers_) {
      if (reader.source->reading.load(std::memory_order_seq_cst) == number) {
        return true;
      }
    }
    return false;
  }

  /// True while some reader holds a claim on a record in [first, last], or scans, or may.
  bool is_any_pinned(uint64_t first, uint64_t last) const noexcept {
    if (unresolved_) {
      return true;
    }
    for (const Reader & reader : readers_) {
      const uint64_t reading = reader.source->reading.load(std::memory_order_seq_cst);
      if ((reading >= first && reading <= last) || reading == every_record) {
        return true;
      }
    }
    return false;
  }

private:
  [[noreturn]] void throw_unresolved(const std::string & topic) const;
  void rebuild();
  /// Throws Error: its cluster cannot be mapped, or its entry leads nowhere.
  Reader resolve(ReaderEntry & entry);

  Registry & registry_;
  Cluster & cluster_;
  TopicDsmHeader & dsm_;
  uint64_t seen_ = 0;  ///< `match_generation` of the copy
  std::vector<Reader> readers_;
  std::optional<Error> unresolved_;  ///< why a reader is missing from the copy
};

}  // namespace manycore
