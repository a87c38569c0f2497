// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/configurator.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "python/context.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/text.hpp"
#include "python/transport/words.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

Profile profile_of(
  uint32_t clusters, uint32_t cores_per_cluster, uint64_t smem_bytes,
  const std::map<uint32_t, int> & host_cpu_of_receive_thread,
  const std::map<uint32_t, int> & priority_of_receive_thread,
  const std::map<uint32_t, int> & numa_node_of_cluster) {
  if (clusters == 0 || clusters > max_clusters) {
    throw nb::value_error("clusters: expected 1 to 64");
  }
  Profile profile = host_profile();
  profile.clusters = clusters;
  profile.cores_per_cluster = cores_per_cluster;
  profile.smem_bytes = smem_bytes != 0 ? smem_bytes / 4096 * 4096 : profile.smem_bytes;
  const auto fill = [&](int32_t * values, const std::map<uint32_t, int> & by_cluster) {
    for (const auto & [cluster, value] : by_cluster) {
      if (cluster >= 1 && cluster <= clusters) {
        values[cluster - 1] = value;
      }
    }
  };
  fill(profile.host_cpu_of_receive_thread, host_cpu_of_receive_thread);
  fill(profile.priority_of_receive_thread, priority_of_receive_thread);
  fill(profile.numa_node, numa_node_of_cluster);
  return profile;
}

/// A configurator that can end before its Python object is destroyed.
class BoundConfigurator {
public:
  BoundConfigurator(
    const std::string & name, uint32_t clusters, uint32_t cores_per_cluster, uint64_t smem_bytes,
    const std::map<uint32_t, int> & host_cpu_of_receive_thread,
    const std::vector<TopicConfiguration> & topics,
    const std::map<uint32_t, int> & priority_of_receive_thread,
    const std::map<uint32_t, int> & numa_node_of_cluster)
  : configurator_(std::make_unique<Configurator>(
      name,
      profile_of(
        clusters, cores_per_cluster, smem_bytes, host_cpu_of_receive_thread,
        priority_of_receive_thread, numa_node_of_cluster),
      topics)) {}

  void close() { configurator_.reset(); }

private:
  std::unique_ptr<Configurator> configurator_;
};

void init_topic(
  TopicConfiguration * topic, const std::string & name, uint32_t id, uint32_t dsm_size_bytes,
  uint64_t receiver_clusters, const std::string & transfer, uint8_t priority, bool synchronous,
  const std::string & zero_copy) {
  if (priority >= transfer_priorities) {
    throw nb::value_error("priority: expected 0 to 7");
  }
  TransferSettings settings;
  settings.kind = from_word<Transfer>(transfer);
  settings.priority = priority;
  settings.synchronous = synchronous ? 1 : 0;
  new (topic) TopicConfiguration{
    name, id, dsm_size_bytes, receiver_clusters, settings, from_word<ZeroCopy>(zero_copy)};
}

}  // namespace

void bind_configurator(nb::module_ & module) {
  nb::class_<TopicConfiguration>(module, "TopicConfiguration")
    .def(
      "__init__", &init_topic, nb::arg("name"), nb::kw_only(), nb::arg("id"),
      nb::arg("dsm_size_bytes"), nb::arg("receiver_clusters"), nb::arg("transfer") = "dsm",
      nb::arg("priority") = 0, nb::arg("synchronous") = false, nb::arg("zero_copy") = "unset")
    .def_prop_ro("name", name<TopicConfiguration>(&TopicConfiguration::name))
    .def_ro("id", &TopicConfiguration::id)
    .def_ro("dsm_size_bytes", &TopicConfiguration::dsm_size_bytes)
    .def_ro("receiver_clusters", &TopicConfiguration::receiver_clusters)
    .def_prop_ro(
      "transfer", [](const TopicConfiguration & topic) { return word_of(topic.transfer.kind); })
    .def_prop_ro(
      "priority", [](const TopicConfiguration & topic) { return topic.transfer.priority; })
    .def_prop_ro(
      "zero_copy", [](const TopicConfiguration & topic) { return word_of(topic.zero_copy); })
    .def_prop_ro("synchronous", [](const TopicConfiguration & topic) {
      return topic.transfer.synchronous != 0;
    });
  nb::class_<BoundConfigurator> bound(module, "Configurator");
  bound.def(
    nb::init<
      const std::string &, uint32_t, uint32_t, uint64_t, const std::map<uint32_t, int> &,
      const std::vector<TopicConfiguration> &, const std::map<uint32_t, int> &,
      const std::map<uint32_t, int> &>(),
    nb::arg("name"), nb::kw_only(), nb::arg("clusters"), nb::arg("cores_per_cluster"),
    nb::arg("smem_bytes"), nb::arg("host_cpu_of_receive_thread"), nb::arg("topics"),
    nb::arg("priority_of_receive_thread") = std::map<uint32_t, int>{},
    nb::arg("numa_node_of_cluster") = std::map<uint32_t, int>{});
  bind_context(bound);
}

}  // namespace manycore::python
