// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/dictionaries.hpp"

#include <nanobind/stl/string.h>

#include <cstdio>

namespace nb = nanobind;

namespace manycore::python {
namespace {

nb::object duration(int64_t ns) { return ns == infinite_ns ? nb::none() : nb::cast(ns); }

int64_t duration_from(const nb::handle & value) {
  return value.is_none() ? infinite_ns : nb::cast<int64_t>(value);
}

/// The position of `text` among two words.
bool second_of(
  const std::string & key, const std::string & text, const char * first, const char * second) {
  if (text == second) {
    return true;
  }
  if (text != first) {
    throw nb::value_error(
      (key + ": expected '" + first + "' or '" + second + "', found '" + text + "'").c_str());
  }
  return false;
}

}  // namespace

std::string hex(const uint8_t * bytes, size_t count) {
  constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (size_t i = 0; i < count; ++i) {
    text += digits[bytes[i] >> 4];
    text += digits[bytes[i] & 15];
  }
  return text;
}

nb::dict to_dict(const Qos & qos) {
  nb::dict out;
  out["reliability"] = qos.reliability == Reliability::reliable ? "reliable" : "best_effort";
  out["durability"] =
    qos.durability == Durability::transient_local ? "transient_local" : "volatile";
  out["history"] = qos.history == History::keep_all ? "keep_all" : "keep_last";
  out["depth"] = qos.depth;
  out["deadline_ns"] = duration(qos.deadline_ns);
  out["lifespan_ns"] = duration(qos.lifespan_ns);
  out["liveliness"] = qos.liveliness == Liveliness::automatic ? "automatic" : "manual_by_topic";
  out["liveliness_lease_ns"] = duration(qos.liveliness_lease_ns);
  return out;
}

nb::dict to_dict(const ProcessInfo & process) {
  nb::dict out;
  out["slot"] = process.slot;
  out["pid"] = process.pid;
  out["cluster"] = process.cluster;
  out["core"] = process.core < 0 ? nb::none() : nb::cast(process.core);
  out["host_cpu"] = process.host_cpu < 0 ? nb::none() : nb::cast(process.host_cpu);
  out["label"] = process.label;
  return out;
}

nb::dict to_dict(const ClusterInfo & cluster) {
  nb::dict out;
  out["id"] = cluster.id;
  out["smem_size"] = cluster.smem_bytes;
  out["used"] = cluster.used_bytes;
  out["charged"] = cluster.charged_bytes;
  out["receive_thread_pid"] = cluster.receive_thread_pid;
  out["messages"] = cluster.messages;
  out["notifications"] = cluster.notifications;
  return out;
}

nb::dict to_dict(const CounterValues & counters) {
  nb::dict out;
  out["messages"] = counters.messages;
  out["bytes"] = counters.bytes;
  out["lost"] = counters.lost;
  out["expired"] = counters.expired;
  out["refused"] = counters.refused;
  out["overwritten"] = counters.overwritten;
  return out;
}

nb::dict to_dict(const EndpointInfo & endpoint, const std::vector<NodeInfo> & nodes) {
  constexpr const char * roles[] = {"topic", "request", "reply"};
  nb::dict entry;
  entry["kind"] = endpoint.kind == EndpointKind::publisher ? "publisher" : "subscription";
  entry["role"] = roles[static_cast<size_t>(endpoint.role)];
  entry["topic"] = endpoint.topic;
  entry["type"] = endpoint.type;
  char version[16];
  std::snprintf(version, sizeof version, "RIHS%02u_", endpoint.type_hash.version);
  entry["type_hash"] =
    version + hex(endpoint.type_hash.value.data(), endpoint.type_hash.value.size());
  entry["gid"] = hex(endpoint.gid.data(), endpoint.gid.size());
  entry["node"] = "";
  entry["namespace"] = "";
  for (const NodeInfo & node : nodes) {
    if (node.handle == endpoint.node) {
      entry["node"] = node.name;
      entry["namespace"] = node.ns;
    }
  }
  entry["cluster"] = endpoint.cluster;
  entry["process"] = endpoint.process;
  entry["qos"] = to_dict(endpoint.qos);
  entry["matched"] = endpoint.matched.current;
  entry["counters"] = to_dict(endpoint.counters);
  return entry;
}

TypeHash type_hash_from(const std::string & text) {
  TypeHash hash;
  unsigned version = 0;
  int digits = 0;
  const bool prefixed = std::sscanf(text.c_str(), "RIHS%2u_%n", &version, &digits) == 1;
  if (!prefixed || text.size() != digits + 2 * hash.value.size()) {
    throw nb::value_error(("no type hash: '" + text + "'").c_str());
  }
  hash.version = static_cast<uint8_t>(version);
  for (uint8_t & byte : hash.value) {
    byte = static_cast<uint8_t>(std::stoi(text.substr(digits, 2), nullptr, 16));
    digits += 2;
  }
  return hash;
}

Qos qos_from(const nb::dict & values) {
  Qos qos;
  for (const auto [key_object, value] : values) {
    const auto key = nb::cast<std::string>(key_object);
    const auto word = [&value = value] { return nb::cast<std::string>(value); };
    if (key == "reliability") {
      qos.reliability = static_cast<Reliability>(second_of(key, word(), "best_effort", "reliable"));
    } else if (key == "durability") {
      qos.durability =
        static_cast<Durability>(second_of(key, word(), "volatile", "transient_local"));
    } else if (key == "history") {
      qos.history = static_cast<History>(second_of(key, word(), "keep_last", "keep_all"));
    } else if (key == "liveliness") {
      qos.liveliness =
        static_cast<Liveliness>(second_of(key, word(), "automatic", "manual_by_topic"));
    } else if (key == "depth") {
      qos.depth = nb::cast<uint32_t>(value);
    } else if (key == "deadline_ns") {
      qos.deadline_ns = duration_from(value);
    } else if (key == "lifespan_ns") {
      qos.lifespan_ns = duration_from(value);
    } else if (key == "liveliness_lease_ns") {
      qos.liveliness_lease_ns = duration_from(value);
    } else {
      throw nb::value_error(("unknown QoS policy '" + key + "'").c_str());
    }
  }
  return qos;
}

}  // namespace manycore::python
