// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/publisher/draft.hpp"

#include <utility>

#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {

Draft::Draft(Writing && writing, TopicDsmWriter & writer, size_t size_bytes)
: writing_(std::move(writing)), writer_(writer) {
  const TopicDsmWriter::Room room = writer.find_room(size_bytes);
  data_ = room.data;
  capacity_bytes_ = room.capacity_bytes;
}

Draft::~Draft() {
  if (writing_.is_on()) {
    writer_.abandon_room();
  }
}

}  // namespace manycore
