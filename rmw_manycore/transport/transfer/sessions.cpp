// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/sessions.hpp"

#include <string>
#include <vector>

#include "platform/error.hpp"
#include "transport/transfer/landing.hpp"

namespace manycore {
namespace {

struct Session {
  std::string name;
  uint32_t from;
  uint32_t to;
};

std::string name_of(Registry & registry, const EndpointEntry & publisher, uint32_t to) {
  const bool has_node = registry.nodes().is_live(publisher.node);
  const std::string node = has_node ? text_of(registry.nodes()[publisher.node].name) : "?";
  return text_of(publisher.topic) + " of " + node + " from cluster " +
         std::to_string(publisher.cluster) + " to " + std::to_string(to);
}

std::vector<Session> open_sessions(Registry & registry) {
  std::vector<Session> open;
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    const EndpointEntry & entry = registry.endpoints()[slot];
    if (
      entry.kind != EndpointKind::publisher || entry.transfer != Transfer::session ||
      !has_memory(entry.slot.state.load())) {
      continue;
    }
    const Cluster * const cluster = registry.map_cluster(entry.block.cluster());
    auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
    const LandingTable * const table =
      cluster == nullptr || dsm == nullptr ? nullptr : landing_table(*cluster, *dsm);
    for (uint32_t id = 1; table != nullptr && id <= max_clusters; ++id) {
      if (table->landings[id - 1].load() != 0) {
        open.push_back({name_of(registry, entry, id), entry.cluster, id});
      }
    }
  }
  return open;
}

[[noreturn]] void refuse(
  const EndpointEntry & publisher, const std::string & where,
  const std::vector<const Session *> & open) {
  std::string names;
  for (const Session * const session : open) {
    names += (names.empty() ? "" : ", ") + session->name;
  }
  throw Error(
    ErrorCode::no_space, "no session for '" + text_of(publisher.topic) + "': " + where + " has " +
                           std::to_string(max_sessions) + " already (" + names +
                           "); give one of these topics another transfer in the mapfile, or move "
                           "its node");
}

}  // namespace

void require_free_session(Registry & registry, const EndpointEntry & publisher, uint32_t receiver) {
  const std::vector<Session> open = open_sessions(registry);
  std::vector<const Session *> out;
  std::vector<const Session *> in;
  for (const Session & session : open) {
    if (session.from == publisher.cluster) {
      out.push_back(&session);
    }
    if (session.to == receiver) {
      in.push_back(&session);
    }
  }
  if (out.size() >= max_sessions) {
    refuse(publisher, "cluster " + std::to_string(publisher.cluster) + " to others", out);
  }
  if (in.size() >= max_sessions) {
    refuse(publisher, "cluster " + std::to_string(receiver) + " from others", in);
  }
}

}  // namespace manycore
