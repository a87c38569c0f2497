// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/entry_table.hpp"

namespace manycore {

/// Readers beyond those in the header; their indices continue after readers_in_header.
inline EntryTable<ReaderEntry> further_readers(
  const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  return {cluster, dsm.further_readers};
}

/// Calls `visit(ReaderEntry &, index)` for each entry from index `from` on, used or free, until it
/// returns true.
template<typename Visit>
void visit_reader_table(
  const Cluster & cluster, TopicDsmHeader & dsm, Visit visit, uint32_t from = 0) {
  for (uint32_t i = from; i < readers_in_header; ++i) {
    if (visit(dsm.readers[i], i)) {
      return;
    }
  }
  further_readers(cluster, dsm)
    .visit(
      std::max(from, readers_in_header) - readers_in_header,
      [&](ReaderEntry & entry, uint32_t i) { return visit(entry, i + readers_in_header); });
}

/// Nullptr beyond the end of the table.
inline ReaderEntry * find_reader(
  const Cluster & cluster, TopicDsmHeader & dsm, uint32_t index) noexcept {
  return index < readers_in_header ? &dsm.readers[index]
                                   : further_readers(cluster, dsm).find(index - readers_in_header);
}

/// Index of an entry of this reader table; nothing for any other entry.
inline std::optional<uint32_t> index_of_reader(
  const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & reader) noexcept {
  if (&reader >= dsm.readers && &reader < dsm.readers + readers_in_header) {
    return static_cast<uint32_t>(&reader - dsm.readers);
  }
  const auto index = further_readers(cluster, dsm).index_of(reader);
  return index ? std::optional(*index + readers_in_header) : std::nullopt;
}

/// Frees an entry. The caller holds the registry lock.
inline void free_reader_entry(
  const Cluster & cluster, TopicDsmHeader & dsm, ReaderEntry & reader) noexcept {
  const uint32_t index = index_of_reader(cluster, dsm, reader).value_or(0);
  dsm.free_reader_from = std::min(dsm.free_reader_from, index);
  reader.active.store(0, std::memory_order_release);
}

/// Calls `visit(ReaderEntry &)` for each active entry.
template<typename Visit>
void for_each_reader(const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  visit_reader_table(cluster, dsm, [&](ReaderEntry & entry, uint32_t) {
    if (entry.active.load(std::memory_order_acquire) != 0) {
      visit(entry);
    }
    return false;
  });
}

}  // namespace manycore
