// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/source_list.hpp"

#include <algorithm>
#include <utility>

#include "transport/queue/source_table.hpp"

namespace manycore {
namespace {

constexpr uint64_t no_source_generation = UINT64_MAX;  ///< matches no `source_generation`

}  // namespace

bool SourceList::renew() {
  const uint64_t generation = header_.source_generation.load(std::memory_order_acquire);
  if (generation == seen_generation_) {
    return false;
  }
  seen_generation_ = generation;
  bool has_new = false;
  std::vector<Source> renewed;
  auto known = sources_.begin();  // sorted by index, like the table
  visit_source_table(cluster_, header_, [&](SourceEntry & entry, uint32_t index) {
    // Load before the state: a use of the entry that begins in between is detected.
    const uint32_t incarnation = entry.incarnation.load(std::memory_order_acquire);
    if (entry.state.load(std::memory_order_acquire) != SourceState::active) {
      return false;
    }
    known = at_or_after(known, index);
    const bool is_known = known != sources_.end() && known->is(entry);
    Source source = is_known ? *known : Source(registry_, entry, {index, incarnation}, entry_);
    if (source) {
      has_new = has_new || !is_known;
      renewed.push_back(source);
    } else {
      seen_generation_ = no_source_generation;  // its cluster cannot be mapped at present
    }
    return false;
  });
  sources_ = std::move(renewed);
  return has_new;
}

Source * SourceList::find(uint32_t index, uint32_t incarnation) noexcept {
  const uint32_t low_bits = incarnation & Hint::incarnation_mask;
  const auto found = at_or_after(sources_.begin(), index);
  const bool is_there = found != sources_.end() && found->index() == index &&
                        (found->incarnation() & Hint::incarnation_mask) == low_bits;
  return is_there ? &*found : nullptr;
}

std::vector<Source>::iterator SourceList::at_or_after(
  std::vector<Source>::iterator from, uint32_t index) noexcept {
  return std::lower_bound(from, sources_.end(), index, [](const Source & source, uint32_t wanted) {
    return source.index() < wanted;
  });
}

}  // namespace manycore
