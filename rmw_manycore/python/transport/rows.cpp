// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings of a platform's processes, clusters, nodes and endpoints, row by row.

#include "python/transport/rows.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <unordered_map>
#include <utility>

#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"
#include "python/transport/text.hpp"
#include "python/transport/type_hash.hpp"
#include "python/transport/words.hpp"
#include "transport/peers/graph_matches.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

auto unless_negative(int32_t ProcessRow::*member) {
  return [member](const ProcessRow & self) {
    return self.*member < 0 ? std::nullopt : std::optional<int32_t>(self.*member);
  };
}

void bind_platform_info(nb::module_ & module) {
  nb::class_<PlatformRow>(module, "PlatformInfo")
    .def_ro("name", &PlatformRow::name)
    .def_prop_ro("clusters", [](const PlatformRow & row) { return row.profile.clusters; })
    .def_prop_ro(
      "cores_per_cluster", [](const PlatformRow & row) { return row.profile.cores_per_cluster; })
    .def_prop_ro("smem_bytes", [](const PlatformRow & row) { return row.profile.smem_bytes; })
    .def_ro("alive", &PlatformRow::alive);
}

void bind_process_info(nb::module_ & module) {
  nb::class_<ProcessRow>(module, "ProcessInfo")
    .def_ro("slot", &ProcessRow::slot)
    .def_ro("pid", &ProcessRow::pid)
    .def_ro("cluster", &ProcessRow::cluster)
    .def_prop_ro("core", unless_negative(&ProcessRow::core))
    .def_prop_ro("host_cpu", unless_negative(&ProcessRow::host_cpu))
    .def_prop_ro("label", name<ProcessRow>(&ProcessRow::label))
    .def_ro("alive", &ProcessRow::alive);
}

void bind_cluster_info(nb::module_ & module) {
  nb::class_<ClusterRow>(module, "ClusterInfo")
    .def_ro("id", &ClusterRow::id)
    .def_ro("smem_bytes", &ClusterRow::smem_bytes)
    .def_ro("used_bytes", &ClusterRow::used_bytes)
    .def_ro("charged_bytes", &ClusterRow::charged_bytes)
    .def_ro("receive_thread_pid", &ClusterRow::receive_thread_pid)
    .def_ro("messages", &ClusterRow::messages)
    .def_ro("notifications", &ClusterRow::notifications)
    .def_ro("alive", &ClusterRow::alive);
}

void bind_death(nb::module_ & module) {
  nb::class_<Death>(module, "Death")
    .def_ro("pid", &Death::pid)
    .def_ro("process", &Death::process)
    .def_ro("found_ns", &Death::found_ns);
}

void bind_node_info(nb::module_ & module) {
  nb::class_<NodeInfo>(module, "NodeInfo")
    .def_ro("handle", &NodeInfo::handle)
    .def_ro("process", &NodeInfo::process)
    .def_prop_ro("name", name<NodeInfo>(&NodeInfo::name))
    .def_prop_ro("namespace", name<NodeInfo>(&NodeInfo::ns))
    .def_prop_ro("enclave", name<NodeInfo>(&NodeInfo::enclave));
}

void bind_counter_values(nb::module_ & module) {
  nb::class_<CounterValues>(module, "CounterValues")
    .def_ro("messages", &CounterValues::messages)
    .def_ro("bytes", &CounterValues::bytes)
    .def_ro("lost", &CounterValues::lost)
    .def_ro("superseded", &CounterValues::superseded)
    .def_ro("expired", &CounterValues::expired)
    .def_ro("refused", &CounterValues::refused)
    .def_ro("overwritten", &CounterValues::overwritten)
    .def_ro("dropped", &CounterValues::dropped)
    .def_ro("in_place", &CounterValues::in_place);
}

void bind_endpoint_info(nb::module_ & module) {
  nb::class_<EndpointRow>(module, "EndpointInfo")
    .def_prop_ro("kind", word<EndpointRow>(&EndpointRow::kind))
    .def_prop_ro("role", word<EndpointRow>(&EndpointRow::role))
    .def_prop_ro("topic", name<EndpointRow>(&EndpointRow::topic))
    .def_prop_ro("type", name<EndpointRow>(&EndpointRow::type))
    .def_prop_ro("type_hash", [](const EndpointRow & row) { return to_text(row.type_hash); })
    .def_ro("id", &EndpointRow::id)
    .def_prop_ro("gid", [](const EndpointRow & row) { return to_bytes(row.gid); })
    .def_prop_ro("node_name", name<EndpointRow>(&EndpointRow::node_name))
    .def_prop_ro("node_namespace", name<EndpointRow>(&EndpointRow::node_namespace))
    .def_ro("cluster", &EndpointRow::cluster)
    .def_ro("process", &EndpointRow::process)
    .def_ro("qos", &EndpointRow::qos)
    .def_prop_ro("matched", [](const EndpointRow & row) { return row.matched; })
    .def_ro("counters", &EndpointRow::counters)
    .def_ro("held_bytes", &EndpointRow::held_bytes)
    .def_prop_ro("transfer", word<EndpointRow>(&EndpointRow::transfer));
}

}  // namespace

std::vector<EndpointRow> rows_of(
  const Graph & graph, std::vector<EndpointInfo> endpoints, HeldMemory held) {
  const std::vector<NodeInfo> nodes = graph.nodes();
  std::unordered_map<uint32_t, const NodeInfo *> by_handle;
  for (const NodeInfo & node : nodes) {
    by_handle.emplace(node.handle, &node);
  }
  const std::vector<uint64_t> matches = count_matches(endpoints);
  std::unordered_map<uint64_t, Activity> activities;
  for (const Activity & activity : graph.activity_of(endpoints, held)) {
    activities.emplace(activity.endpoint, activity);
  }
  std::vector<EndpointRow> rows;
  for (size_t i = 0; i < endpoints.size(); ++i) {
    const auto found = activities.find(endpoints[i].id);
    if (found == activities.end()) {
      continue;
    }
    const Activity & activity = found->second;
    EndpointRow & row = rows.emplace_back(EndpointRow{
      std::move(endpoints[i]), activity.counters, activity.held_bytes, "", "", matches[i]});
    const auto node = by_handle.find(row.node);
    if (node != by_handle.end()) {
      row.node_name = node->second->name;
      row.node_namespace = node->second->ns;
    }
  }
  return rows;
}

void bind_rows(nb::module_ & module) {
  bind_platform_info(module);
  bind_process_info(module);
  bind_death(module);
  bind_cluster_info(module);
  bind_node_info(module);
  bind_counter_values(module);
  bind_endpoint_info(module);
}

}  // namespace manycore::python
