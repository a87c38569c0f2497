// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/lasting_descriptor.hpp"

namespace manycore {

/// The eMCOS message primitive on the host: a FIFO for messages of one fixed size, at most
/// PIPE_BUF, so that each write is atomic. Each process opens it for reading and writing, so its
/// content survives the death of the receive thread.
class Pipe {
public:
  /// Creates the FIFO with mode 0600 unless it exists.
  static void create(const std::string & path);
  /// Opens an existing FIFO; never creates it, because its directory may be about to be removed.
  static Pipe open(const std::string & path);

  /// Never blocks. False if the pipe is full or cannot be opened again.
  bool try_send(const void * message, size_t size_bytes) const noexcept;

  /// Sends a message that supersedes all others: discards unread messages if the pipe is full.
  void send_last(const void * message, size_t size_bytes) const noexcept;

  /// Blocks until a message arrives. Returns the bytes read, or 0 if interrupted.
  size_t receive(void * buffer, size_t capacity_bytes) const;

  /// Waits until a message of PIPE_BUF bytes may fit, at most until `until_ns` (CLOCK_MONOTONIC).
  /// False when the time is over, or the pipe is out of reach.
  bool wait_for_room(int64_t until_ns) const noexcept;

  /// Bytes that were sent and not received yet.
  size_t waiting_bytes() const noexcept;

  /// Blocks until one of these pipes has a message; the index of the first that has. Throws
  /// Error{system}.
  static size_t wait_for_first(const std::vector<Pipe> & pipes);

private:
  explicit Pipe(LastingDescriptor sender, LastingDescriptor receiver)
  : sender_(std::move(sender)), receiver_(std::move(receiver)) {}

  LastingDescriptor sender_;  ///< O_NONBLOCK
  /// Blocking. Opened separately, because O_NONBLOCK belongs to the open file description.
  LastingDescriptor receiver_;
};

}  // namespace manycore
