// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/configurator.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "python/transport/bindings.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

using TopicLine = std::tuple<std::string, uint32_t, uint32_t, uint64_t>;

Configurator * configure(
  const std::string & name, uint32_t clusters, uint32_t cores_per_cluster, uint64_t smem_size,
  const std::map<uint32_t, int> & host_cpu_of_receive_thread,
  const std::vector<TopicLine> & topic_lines) {
  Profile profile = host_profile();
  if (clusters == 0 || clusters > max_clusters) {
    throw nb::value_error("clusters: expected 1 to 64");
  }
  profile.clusters = clusters;
  profile.cores_per_cluster = cores_per_cluster;
  profile.smem_bytes = smem_size != 0 ? smem_size / 4096 * 4096 : profile.smem_bytes;
  for (const auto & [cluster, cpu] : host_cpu_of_receive_thread) {
    if (cluster >= 1 && cluster <= clusters) {
      profile.host_cpu_of_receive_thread[cluster - 1] = cpu;
    }
  }
  std::vector<TopicConfiguration> topics;
  for (const auto & [topic, id, size, receivers] : topic_lines) {
    topics.push_back({topic, id, size, receivers});
  }
  return new Configurator(name, profile, topics);
}

}  // namespace

void bind_configurator(nb::module_ & module) {
  module.def("clean", &clean_platform, nb::arg("name"));
  nb::class_<Configurator>(module, "Configurator")
    .def(
      nb::new_(&configure), nb::arg("name"), nb::kw_only(), nb::arg("clusters"),
      nb::arg("cores_per_cluster"), nb::arg("smem_size"), nb::arg("host_cpu_of_receive_thread"),
      nb::arg("topics"));
}

}  // namespace manycore::python
