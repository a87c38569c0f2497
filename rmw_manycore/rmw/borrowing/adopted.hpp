// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "rmw/borrowing/interface.hpp"
#include "transport/process.hpp"
#include "transport/subscription/hold.hpp"

namespace rmw_manycore {

struct RecordHold {
  /// A hold must not outlive it: the context may be shut down before.
  const std::shared_ptr<manycore::Process> process;
  const manycore::Hold hold;
  const Access access;
};

/// What a message left in the record that it was taken from.
struct Borrowed {
  std::unique_ptr<RecordHold> hold;  ///< null: nothing
  std::vector<std::string> paths;
  std::vector<BorrowedSequence> sequences;
};

struct AdoptedMessage {
  bool is_read_only;  ///< its owner does not write into records
  Borrowed borrowed;
};

/// The messages whose owner reads large sequences in their record. Thread-safe; what belongs to a
/// message is for the thread that uses the message.
class Adopted {
public:
  /// The one of this process.
  static Adopted & messages();

  /// Throws std::bad_alloc.
  void add(const void * message, bool is_read_only);
  void remove(const void * message) noexcept;
  /// Null if the message is not adopted; else valid until it is removed.
  AdoptedMessage * find(const void * message) noexcept;

private:
  std::mutex mutex_;
  std::unordered_map<const void *, AdoptedMessage> messages_;
  std::atomic<size_t> count_{0};  ///< lets programs without any skip the mutex
};

}  // namespace rmw_manycore
