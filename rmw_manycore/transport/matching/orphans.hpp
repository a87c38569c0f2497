// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

/// Publishers that are gone and whose messages subscriptions may still take. The caller holds the
/// registry lock. See docs/design/freeing.md.
namespace manycore::orphans {

/// A reader of the topic DSM of a publisher that is gone.
struct Reader {
  const Cluster & cluster;  ///< of the topic DSM
  TopicDsmHeader & dsm;
  SubscriptionHeader & subscription;
  SourceEntry & source;
  const EndpointEntry & endpoint;  ///< of the subscription
  uint32_t endpoint_slot;
  uint32_t source_index;
};

/// The reader of a reader table's entry, or nothing if the entry is invalid. Throws
/// ClusterUnmappable.
std::optional<Reader> reader_of(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & entry);

/// Calls `visit(Reader &, ReaderEntry &)` for each valid reader. Throws ClusterUnmappable.
void for_each_reader(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm,
  const std::function<void(const Reader &, ReaderEntry &)> & visit);

/// What readers of one topic DSM have not taken.
class Untaken {
public:
  Untaken(const Cluster & cluster, TopicDsmHeader & dsm);
  /// Number of messages, expired ones included. Of replies, whether there is one for the client
  /// whose hint was not displaced: 1 or 0.
  uint64_t of(const Reader & reader) const noexcept;

private:
  struct Reply {
    Gid client;
    uint64_t number;
  };
  bool has_reply(const Reader & reader) const noexcept;

  TopicDsmHeader & dsm_;
  std::vector<Reply> replies_;  ///< in the topic DSM, ordered
};

/// Cuts what the subscriptions of a topic keep of publishers that are gone, down to their history:
/// revokes the sources of a subscription beyond the newest `depth` untaken messages, whole topic
/// DSMs at a time, those of the publishers that left last being the newest. A KEEP_ALL subscription
/// keeps as many publishers as its queue holds hints. Appends the slots of the publishers that lost
/// a reader. Throws ClusterUnmappable.
void cut(Registry & registry, const char * topic, std::vector<uint32_t> & unread);

/// Counts what the reader has not taken as lost. Requires that nothing of the topic DSM can be
/// claimed any more.
void count_undelivered(Registry & registry, const Reader & reader);

}  // namespace manycore::orphans
