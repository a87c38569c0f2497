// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Binding of a read-only view of a platform, which neither joins it nor keeps it alive.

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <unistd.h>

#include <memory>
#include <optional>

#include "platform/private_directory.hpp"
#include "platform/user_directory.hpp"
#include "python/context.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/rows.hpp"
#include "transport/lifecycle/cleaning.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/registry/graph.hpp"
#include "transport/registry/smem_charge.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

class Platform {
public:
  explicit Platform(const std::string & name) : name_(name) { view_.emplace(name); }

  PlatformRow info() const {
    Registry & registry = view().registry;
    return {name_, registry.header().profile, is_alive(registry.paths())};
  }

  std::vector<ProcessRow> processes() const {
    const Lifelines & alive = view().registry.lifelines();
    std::vector<ProcessRow> rows;
    for (const ProcessInfo & process : view().graph.processes()) {
      rows.push_back({process, alive.is_held(process.slot)});
    }
    return rows;
  }

  std::vector<ClusterRow> clusters() const {
    const Lifelines & alive = view().registry.lifelines();
    std::vector<ClusterRow> rows;
    for (const ClusterInfo & cluster : view().graph.clusters()) {
      rows.push_back({cluster, alive.is_held(receive_thread_line + cluster.id)});
    }
    return rows;
  }

  std::vector<NodeInfo> nodes() const { return view().graph.nodes(); }

  std::vector<EndpointRow> endpoints() const {
    return rows_of(view().graph, view().graph.endpoints(), HeldMemory::counted);
  }

  uint64_t graph_generation() const { return view().graph.generation(); }

  nb::bytes activity() const {
    const std::vector<Activity> rows = view().graph.activity();
    return nb::bytes(reinterpret_cast<const char *>(rows.data()), rows.size() * sizeof(Activity));
  }

  std::vector<Death> deaths() const { return view().graph.deaths(); }

  bool is_current() const { return view().registry.is_current(); }

  std::vector<TopicConfiguration> topic_table() const {
    Registry & registry = view().registry;
    std::vector<TopicConfiguration> rows;
    for (uint32_t i = 0; i < registry.header().topic_count; ++i) {
      const TopicEntry & topic = registry.topic(i);
      rows.push_back(
        {text_of(topic.name), topic.topic_id, topic.topic_dsm_size, topic.receiver_clusters,
         topic.transfer, topic.zero_copy});
    }
    return rows;
  }

  void close() { view_.reset(); }

private:
  struct View {
    explicit View(const std::string & name)
    : opened(look_at(PlatformPaths::of(name))), registry(*opened), graph(registry) {}

    std::unique_ptr<Registry> opened;
    Registry & registry;
    Graph graph;
  };

  View & view() const {
    if (!view_) {
      throw nb::value_error("the view of the platform is closed");
    }
    return *view_;
  }

  std::string name_;
  mutable std::optional<View> view_;
};

/// Its files are opened by Python: refuses a directory that is not private to this user.
std::string directory_of(const std::string & platform) {
  const std::string directory = PlatformPaths::of(platform).directory;
  PrivateDirectory::open(directory);
  return directory;
}

void charge(const std::string & platform, uint64_t size_bytes) {
  Registry registry(PlatformPaths::of(platform));
  charge_smem(registry, ProcessIdentity::own(), size_bytes);
}

}  // namespace

void bind_platform(nb::module_ & module) {
  module.def("platforms", &platform_names);
  module.def("platform_directory", &directory_of);
  module.def("platforms_place", [] { return UserDirectory::from_environment().place(); });
  module.def("clean", &clean_platform, nb::arg("name"), nb::arg("force") = false);
  module.def(
    "charge_smem", &charge, nb::arg("platform"), nb::arg("size_bytes"),
    nb::call_guard<nb::gil_scoped_release>());
  nb::class_<Platform> bound(module, "Platform");
  bound
    .def(nb::init<const std::string &>(), nb::arg("name"), nb::call_guard<nb::gil_scoped_release>())
    .def("info", &Platform::info)
    .def("processes", &Platform::processes)
    .def("clusters", &Platform::clusters)
    .def("nodes", &Platform::nodes)
    .def("endpoints", &Platform::endpoints)
    .def("graph_generation", &Platform::graph_generation)
    .def("activity", &Platform::activity)
    .def("deaths", &Platform::deaths)
    .def("is_current", &Platform::is_current)
    .def("topic_table", &Platform::topic_table);
  bind_context(bound);
}

}  // namespace manycore::python
