// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "platform/error.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// One reader of the publisher's own topic DSM, resolved to addresses in this process.
struct Reader {
  SourceEntry * source = nullptr;
  SubscriptionHeader * subscription = nullptr;
  WakeWords * wake = nullptr;
  uint32_t cluster = 0;
  uint32_t endpoint = 0;
  uint32_t index = 0;  ///< in the reader table
  uint32_t source_index = 0;
  uint32_t source_incarnation = 0;
  bool reliable = false;
  Gid gid{};

  /// seq_cst: a waiting publisher loads the state after it stored `writer_waits` (see
  /// notify_waiting_publisher()).
  bool active() const noexcept {
    return source->state.load(std::memory_order_seq_cst) == SourceState::active;
  }
};

/// Consecutive readers of a ReaderList, valid until it is rebuilt.
class Readers {
public:
  Readers(const Reader * first, size_t count) noexcept : first_(first), count_(count) {}

  const Reader * begin() const noexcept { return first_; }
  const Reader * end() const noexcept { return first_ + count_; }
  size_t size() const noexcept { return count_; }

private:
  const Reader * first_;
  size_t count_;
};

/// A publisher's private copy of its reader table, rebuilt when the table changes. Its addresses
/// are valid while the publisher's phase is odd (see docs/design/freeing.md). A copy that could not
/// be made, or lacks a reader that cannot be reached, is incomplete: it is made anew at each look.
class ReaderList {
public:
  ReaderList(Registry & registry, Cluster & cluster, TopicDsmHeader & dsm) noexcept
  : registry_(registry), cluster_(cluster), dsm_(dsm) {}

  /// At the begin of a phase. Forgets the copy of the former phase, whose readers may be freed, if
  /// there is no memory for a new one.
  void begin_phase() noexcept {
    if (!is_current() && !rebuild()) {
      readers_.clear();
      by_gid_.clear();
    }
  }
  /// Rebuilds the copy if the table changed. Where there is no memory for that, keeps the copy of
  /// earlier in this phase. The load is seq_cst: it must not be reordered before the caller's
  /// preceding seq_cst store of `phase`, `number` or `last`.
  void refresh() noexcept {
    if (!is_current()) {
      rebuild();
    }
  }
  bool is_complete() const noexcept { return !failure_; }

  Readers all() const noexcept { return {readers_.data(), readers_.size()}; }
  /// The reader with this gid, or none. Takes O(log readers): a server has one reader per client.
  Readers with_gid(const Gid & gid) const noexcept;

  /// Throws Error{system|permission|corrupt} naming the topic if a reader cannot be resolved, and
  /// std::bad_alloc if there was no memory for the copy.
  void require_all(const char * topic) const {
    if (!is_complete()) {
      throw_failure(topic);
    }
  }
  /// Makes each subscription in the table look for records itself. For a record that is published
  /// already while the copy is incomplete: needs no memory.
  void request_resyncs() const noexcept;

  /// True while a reader has, or may have, a claim on record `number`. The claims of a reader that
  /// is missing from the copy are invisible, so it may have one on any record.
  bool is_pinned(uint64_t number) const noexcept {
    if (!is_complete()) {
      return true;
    }
    for (const Reader & reader : readers_) {
      if (reader.source->reading.load(std::memory_order_seq_cst) == number) {
        return true;
      }
    }
    return false;
  }

  /// True while a reader has, or may have, a claim on a record in [first, last], or scans a
  /// generation that begins there.
  bool is_any_pinned(uint64_t first, uint64_t last) const noexcept {
    if (!is_complete()) {
      return true;
    }
    for (const Reader & reader : readers_) {
      const uint64_t reading =
        reader.source->reading.load(std::memory_order_seq_cst) & ~whole_generation;
      if (reading >= first && reading <= last) {
        return true;
      }
    }
    return false;
  }

private:
  bool is_current() const noexcept {
    return dsm_.match_generation.load(std::memory_order_seq_cst) == seen_;
  }
  [[noreturn]] void throw_failure(const std::string & topic) const;
  /// False if there is no memory.
  bool rebuild() noexcept;
  void copy_table();
  void add(ReaderEntry & entry, uint32_t index);
  /// Throws Error if the cluster cannot be mapped or the entry is invalid.
  Reader resolve(ReaderEntry & entry);

  Registry & registry_;
  Cluster & cluster_;
  TopicDsmHeader & dsm_;
  uint64_t seen_ = 0;  ///< value of `match_generation` when copied
  std::vector<Reader> readers_;
  std::vector<uint32_t> by_gid_;  ///< indices of readers_, ordered by gid
  std::vector<Reader> next_;      ///< the next copy while it is made; otherwise spare storage
  std::vector<uint32_t> next_by_gid_;
  std::exception_ptr failure_;  ///< why the copy is incomplete
};

}  // namespace manycore
