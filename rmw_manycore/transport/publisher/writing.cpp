// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/publisher/writing.hpp"

#include "transport/registry/membership.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {

Writing::Writing(std::mutex & mutex, TopicDsmWriter & writer, const Membership & membership)
: lock_(mutex), writer_(writer), membership_(membership) {
  writer_.enter();
}

Writing::~Writing() {
  if (is_on()) {
    writer_.leave();
  } else {
    lock_.release();
  }
}

bool Writing::is_on() const noexcept { return lock_.owns_lock() && !membership_.is_inherited(); }

}  // namespace manycore
