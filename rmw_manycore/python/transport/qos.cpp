// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/layout/qos.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <tuple>

#include "python/transport/bindings.hpp"
#include "python/transport/words.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

using Duration = std::optional<int64_t>;  ///< nanoseconds; none = no limit

int64_t duration_ns(const Duration & duration) { return duration.value_or(infinite_ns); }

auto duration(int64_t Qos::*member) {
  return [member](const Qos & self) {
    return self.*member == infinite_ns ? Duration() : Duration(self.*member);
  };
}

void init_qos(
  Qos * qos, const std::string & reliability, const std::string & durability,
  const std::string & history, uint32_t depth, const Duration & deadline_ns,
  const Duration & lifespan_ns, const std::string & liveliness,
  const Duration & liveliness_lease_ns) {
  new (qos) Qos{
    duration_ns(deadline_ns),
    duration_ns(lifespan_ns),
    duration_ns(liveliness_lease_ns),
    depth,
    from_word<Reliability>(reliability),
    from_word<Durability>(durability),
    from_word<History>(history),
    from_word<Liveliness>(liveliness)};
}

auto policies(const Qos & qos) {
  return std::tie(
    qos.reliability, qos.durability, qos.history, qos.depth, qos.deadline_ns, qos.lifespan_ns,
    qos.liveliness, qos.liveliness_lease_ns);
}

}  // namespace

void bind_qos(nb::module_ & module) {
  const Qos defaults;
  nb::class_<Qos> bound(module, "Qos");
  bound
    .def(
      "__init__", &init_qos, nb::kw_only(), nb::arg("reliability") = word_of(defaults.reliability),
      nb::arg("durability") = word_of(defaults.durability),
      nb::arg("history") = word_of(defaults.history), nb::arg("depth") = defaults.depth,
      nb::arg("deadline_ns") = nb::none(), nb::arg("lifespan_ns") = nb::none(),
      nb::arg("liveliness") = word_of(defaults.liveliness),
      nb::arg("liveliness_lease_ns") = nb::none())
    .def_prop_ro("reliability", word<Qos>(&Qos::reliability))
    .def_prop_ro("durability", word<Qos>(&Qos::durability))
    .def_prop_ro("history", word<Qos>(&Qos::history))
    .def_ro("depth", &Qos::depth)
    .def_prop_ro("deadline_ns", duration(&Qos::deadline_ns))
    .def_prop_ro("lifespan_ns", duration(&Qos::lifespan_ns))
    .def_prop_ro("liveliness", word<Qos>(&Qos::liveliness))
    .def_prop_ro("liveliness_lease_ns", duration(&Qos::liveliness_lease_ns))
    .def(
      "__eq__",
      [](const Qos & self, const Qos & other) { return policies(self) == policies(other); },
      nb::is_operator());
  bound.attr("__hash__") = nb::none();
}

}  // namespace manycore::python
