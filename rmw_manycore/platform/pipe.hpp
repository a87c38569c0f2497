// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "platform/lasting_descriptor.hpp"

namespace manycore {

/// The eMCOS message primitive on the host: a FIFO that carries messages of one fixed size, at most
/// PIPE_BUF, so that each write is atomic. Opened for reading and writing by everybody: what lies
/// in it survives the death of its reader.
class Pipe {
public:
  /// Creates the FIFO (mode 0600) where it is missing.
  static void create(const std::string & path);
  /// Creates nothing: its directory may be on its way out.
  static Pipe open(const std::string & path);

  /// False when the pipe is full, or out of reach; the sender never waits.
  bool try_send(const void * message, size_t size_bytes) const noexcept;

  /// For a message that makes those before it void: where the pipe is full, some of them are taken
  /// away.
  void send_last(const void * message, size_t size_bytes) const noexcept;

  /// Blocks until at least one message is there; returns the bytes read, 0 when interrupted.
  size_t receive(void * buffer, size_t capacity_bytes) const;

private:
  explicit Pipe(LastingDescriptor sender, LastingDescriptor receiver)
  : sender_(std::move(sender)), receiver_(std::move(receiver)) {}

  LastingDescriptor sender_;  ///< O_NONBLOCK
  /// Blocking; a description of its own, since O_NONBLOCK belongs to one.
  LastingDescriptor receiver_;
};

}  // namespace manycore
