// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"
#include "transport/layout/emcos_message.hpp"
#include "transport/layout/segment_layout.hpp"

namespace manycore {

/// How the records of a topic reach other clusters (ROS-lite II-B2, thesis Table 2.1). See
/// docs/design/transfers.md.
enum class Transfer : uint8_t {
  dsm,      ///< they do not move: subscriptions read them in the publisher's cluster
  message,  ///< in packets through the receiving cluster's data pipes
  session,  ///< the publisher's cluster has a thread that copies between fixed buffers
  async,    ///< the publisher puts them into the receiving cluster itself
};

/// How a topic is transferred: a part of its configuration.
struct TransferSettings {
  Transfer kind = Transfer::dsm;
  uint8_t priority = 0;     ///< message: 0 to 7, the highest is received first
  uint8_t synchronous = 0;  ///< message: publishing waits until the receiving clusters have it
  uint8_t reserved[5] = {};
};
static_assert(sizeof(TransferSettings) == 8 && std::is_trivially_copyable_v<TransferSettings>);

constexpr uint32_t transfer_priorities = 8;
constexpr uint32_t landing_magic = 0x4d43'4c44;  // "MCLD"

/// Follows the header of a transferred topic DSM, in the same allocation. Written under the
/// registry lock.
struct LandingTable {
  /// Index cluster - 1: offset of the landing in that cluster; 0 = no subscription there.
  std::atomic<uint64_t> landings[max_clusters];
  /// The landing whose last subscription has gone, until no thread can follow a reference to it.
  /// Where both are set they are one: a process died between two stores.
  std::atomic<uint64_t> retired[max_clusters];
};
static_assert(sizeof(LandingTable) == 1024);

/// Where the records of one publisher arrive in one receiving cluster: a mirror of the data of its
/// topic DSM in that cluster's SMEM. Header, one mark per descriptor, data; a record lies at the
/// same distance from the beginning of the data as in the topic DSM.
struct LandingHeader {
  std::atomic<uint32_t> magic;
  std::atomic<uint32_t> endpoint;     ///< slot of the publisher
  std::atomic<uint32_t> incarnation;  ///< of that slot

  /// Written by the publisher, in this order. A record between the two was dropped. `handed` goes
  /// back by one record if a mover was killed meanwhile; its closer stores `decided`, too.
  alignas(64) std::atomic<uint64_t> handed;  ///< highest number handed to the transfer
  std::atomic<uint64_t> decided;             ///< highest number whose hand-over has ended

  /// Written by the thread that fills the landing: the data, its mark, then these in this order.
  alignas(64) std::atomic<uint64_t> arrived;  ///< highest number that is here
  std::atomic<uint64_t> done;                 ///< highest number that is here or never will be
  std::atomic<uint64_t> partial_number;       ///< message: record whose packets are arriving
  std::atomic<uint64_t> partial_bytes;        ///< message: of it, in order
  FutexWord progress;                         ///< raised with `done` while a publisher waits
  std::atomic<uint32_t> sender_waits;

  std::atomic<uint64_t> * marks() noexcept {
    return reinterpret_cast<std::atomic<uint64_t> *>(this + 1);
  }
};
static_assert(sizeof(LandingHeader) == 192);

/// `publish` messages of a transferred topic carry where the record lies.
struct RecordPlace {
  uint64_t begin;  ///< from the beginning of the topic DSM's data
  uint64_t size_bytes;
};

/// What travels through a data pipe. All have one size, at most PIPE_BUF, so each is written and
/// read whole; the reader of a killed process's pipe finds no half packet.
struct Packet {
  EmcosMessage announcement;  ///< to the receiving cluster's receive thread, once all is here
  RecordPlace place;          ///< of the whole record
  uint64_t offset;            ///< of this packet's data in the record
  uint32_t size_bytes;        ///< of this packet's data
  uint32_t reserved;
  uint8_t data[4096 - 96];
};
static_assert(sizeof(Packet) == 4096 && sizeof(Packet) <= PIPE_BUF);
static_assert(std::is_trivially_copyable_v<Packet>);

/// What travels through a session pipe: one record to be copied.
struct CopyRequest {
  EmcosMessage announcement;
  RecordPlace place;
  uint32_t to_cluster;
  uint32_t reserved[11];
};
static_assert(sizeof(CopyRequest) == 128 && sizeof(CopyRequest) <= PIPE_BUF);

/// Sessions of a cluster in each direction, as many as a NoC interface of the MPPA has UC.
constexpr uint32_t max_sessions = 8;

}  // namespace manycore
