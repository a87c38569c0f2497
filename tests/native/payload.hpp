// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>

/// Content of a test message: writer, number, and bytes derived from both, so that torn, mixed or
/// truncated messages are detected.
struct Payload {
  uint64_t writer;
  uint64_t number;  ///< from 1
  uint64_t size_bytes;

  /// Requires size_bytes >= sizeof(Payload).
  void write(uint8_t * to) const noexcept;
  /// Throws if the bytes are not a complete message of one writer.
  static Payload read(const uint8_t * from, size_t size_bytes);

private:
  uint64_t word(size_t offset) const noexcept {
    uint64_t x = (writer << 32 ^ number) + offset * 0x9e37'79b9'7f4a'7c15;
    x ^= x >> 29;
    return x * 0xbf58'476d'1ce4'e5b9;
  }
};

inline void Payload::write(uint8_t * to) const noexcept {
  std::memcpy(to, this, sizeof *this);
  for (size_t offset = sizeof *this; offset < size_bytes; offset += 8) {
    const uint64_t content = word(offset);
    std::memcpy(to + offset, &content, size_bytes - offset < 8 ? size_bytes - offset : 8);
  }
}

inline Payload Payload::read(const uint8_t * from, size_t size_bytes) {
  Payload payload{};
  if (size_bytes < sizeof payload) {
    throw std::runtime_error("torn message: too short");
  }
  std::memcpy(&payload, from, sizeof payload);
  bool sound = payload.size_bytes == size_bytes;
  for (size_t offset = sizeof payload; sound && offset < size_bytes; offset += 8) {
    const uint64_t content = payload.word(offset);
    sound =
      std::memcmp(from + offset, &content, size_bytes - offset < 8 ? size_bytes - offset : 8) == 0;
  }
  if (!sound) {
    throw std::runtime_error("torn message");
  }
  return payload;
}
