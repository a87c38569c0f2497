// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "python/words.hpp"
#include "transport/layout/chunk_layout.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/transfer_layout.hpp"
#include "transport/waiting/waiter.hpp"

namespace manycore::python {

/// Words of the transport's enumerations in Python.
template<>
struct Words<Reliability> {
  static constexpr const char * name = "reliability";
  static constexpr std::array<const char *, 2> all = {"best_effort", "reliable"};
};

template<>
struct Words<Durability> {
  static constexpr const char * name = "durability";
  static constexpr std::array<const char *, 2> all = {"volatile", "transient_local"};
};

template<>
struct Words<History> {
  static constexpr const char * name = "history";
  static constexpr std::array<const char *, 2> all = {"keep_last", "keep_all"};
};

template<>
struct Words<Liveliness> {
  static constexpr const char * name = "liveliness";
  static constexpr std::array<const char *, 2> all = {"automatic", "manual_by_topic"};
};

template<>
struct Words<WaitMode> {
  static constexpr const char * name = "wait";
  static constexpr std::array<const char *, 3> all = {"block", "adaptive", "spin"};
};

template<>
struct Words<EndpointKind> {
  static constexpr const char * name = "kind";
  static constexpr std::array<const char *, 2> all = {"publisher", "subscription"};
};

template<>
struct Words<EndpointRole> {
  static constexpr const char * name = "role";
  static constexpr std::array<const char *, 3> all = {"topic", "request", "reply"};
};

template<>
struct Words<Transfer> {
  static constexpr const char * name = "transfer";
  static constexpr std::array<const char *, 4> all = {"dsm", "message", "session", "async"};
};

template<>
struct Words<ZeroCopy> {
  static constexpr const char * name = "zero_copy";
  static constexpr std::array<const char *, 4> all = {"unset", "sole", "read_only", "off"};
};

}  // namespace manycore::python
