// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>

#include "transport/process.hpp"

namespace manycore::python {

/// A publisher and the membership it needs.
class BoundPublisher {
public:
  BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec);

  uint64_t publish(
    const nanobind::bytes & data, std::optional<int64_t> source_timestamp_ns,
    const std::optional<nanobind::bytes> & client, int64_t number);
  uint64_t publish_from(uintptr_t address, size_t size, std::optional<int64_t> source_timestamp_ns);
  nanobind::bytes gid() const;
  uint64_t matched() const { return publisher_->matched().current; }

private:
  uint64_t send(
    const void * bytes, size_t size, std::optional<int64_t> source_timestamp_ns,
    const Correlation & correlation);

  std::shared_ptr<Process> process_;
  std::unique_ptr<Publisher> publisher_;
};

}  // namespace manycore::python
