// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The view of a platform: does not join, does not keep it alive.

#include <unistd.h>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "python/transport/bindings.hpp"
#include "python/transport/dictionaries.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/registry/graph.hpp"
#include "transport/registry/smem_charge.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

class Platform {
public:
  explicit Platform(const std::string & name)
  : name_(name), registry_(PlatformPaths::of(name)), graph_(registry_) {}

  nb::dict info() const {
    const Profile & profile = registry_.header().profile;
    nb::dict out;
    out["name"] = name_;
    out["clusters"] = profile.clusters;
    out["cores_per_cluster"] = profile.cores_per_cluster;
    out["smem_size"] = profile.smem_bytes;
    out["alive"] = is_alive(registry_.paths());
    return out;
  }

  nb::list processes() const {
    const ByteLocks & alive = alive_locks(registry_.paths());
    nb::list all;
    for (const ProcessInfo & process : graph_.processes()) {
      nb::dict entry = to_dict(process);
      entry["alive"] = alive.is_held(process.slot);
      all.append(entry);
    }
    return all;
  }

  nb::list clusters() const {
    const ByteLocks & alive = alive_locks(registry_.paths());
    nb::list all;
    for (const ClusterInfo & cluster : graph_.clusters()) {
      nb::dict entry = to_dict(cluster);
      entry["alive"] = alive.is_held(receive_thread_byte + cluster.id);
      all.append(entry);
    }
    return all;
  }

  nb::list nodes() const {
    nb::list all;
    for (const NodeInfo & node : graph_.nodes()) {
      nb::dict entry;
      entry["handle"] = node.handle;
      entry["process"] = node.process;
      entry["name"] = node.name;
      entry["namespace"] = node.ns;
      entry["enclave"] = node.enclave;
      all.append(entry);
    }
    return all;
  }

  nb::list endpoints() const {
    const std::vector<NodeInfo> nodes = graph_.nodes();
    nb::list all;
    for (const EndpointInfo & endpoint : graph_.endpoints()) {
      all.append(to_dict(endpoint, nodes));
    }
    return all;
  }

  nb::list topic_table() const {
    nb::list all;
    for (uint32_t i = 0; i < registry_.header().topic_count; ++i) {
      const TopicEntry & topic = registry_.topic(i);
      nb::dict entry;
      entry["topic_name"] = std::string(topic.name);
      entry["topic_id"] = topic.topic_id;
      entry["topic_dsm_size"] = topic.topic_dsm_size;
      entry["receiver_clusters"] = topic.receiver_clusters;
      all.append(entry);
    }
    return all;
  }

private:
  std::string name_;
  mutable Registry registry_;
  Graph graph_;
};

}  // namespace

void bind_platform(nb::module_ & module) {
  module.def("platforms", &platform_names);
  module.def("platform_directory", [](const std::string & name) {
    return PlatformPaths::of(name).directory;
  });
  module.def(
    "charge_smem",
    [](const std::string & name, uint64_t size_bytes) {
      Registry registry(PlatformPaths::of(name));
      charge_smem(registry, getpid(), size_bytes);
    },
    nb::arg("platform"), nb::arg("size_bytes"), nb::call_guard<nb::gil_scoped_release>());
  nb::class_<Platform>(module, "Platform")
    .def(nb::init<const std::string &>(), nb::arg("name"))
    .def("info", &Platform::info)
    .def("processes", &Platform::processes)
    .def("clusters", &Platform::clusters)
    .def("nodes", &Platform::nodes)
    .def("endpoints", &Platform::endpoints)
    .def("topic_table", &Platform::topic_table);
}

}  // namespace manycore::python
