// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/source_list.hpp"

#include <algorithm>
#include <new>
#include <utility>

namespace manycore {

void SourceList::renew() {
  try {
    if (publishers_.refresh()) {
      rebuild();
    }
  } catch (const std::bad_alloc &) {
    publishers_.forget_changes();  // the next call tries again
    lacks_some_ = true;
    throw;
  }
}

void SourceList::try_to_renew() noexcept {
  try {
    renew();
  } catch (const std::bad_alloc &) {
  }
}

void SourceList::rebuild() {
  const bool lacked_some = std::exchange(lacks_some_, false);
  std::vector<Source> renewed;
  renewed.reserve(publishers_.all().size());
  for (const Peer & publisher : publishers_.all()) {
    const auto known = at_or_after(publisher.slot);
    const bool is_known = known != sources_.end() && known->slot() == publisher.slot &&
                          known->incarnation() == publisher.incarnation;
    const Source source = is_known ? *known : Source(registry_, publisher, header_, entry_);
    if (source) {
      renewed.push_back(source);
      if (lacked_some && !is_known) {
        header_.resync.store(1, std::memory_order_seq_cst);
      }
    } else {
      lacks_some_ = true;
      publishers_.forget_changes();  // its cluster cannot be mapped at present
    }
  }
  std::sort(renewed.begin(), renewed.end(), [](const Source & a, const Source & b) {
    return a.slot() < b.slot();
  });
  sources_ = std::move(renewed);
}

Source * SourceList::find(const Hint & hint) {
  if (Source * const known = find_known(hint)) {
    return known;
  }
  renew();
  return find_known(hint);
}

/// One whose slot has another owner may have the same low bits of the incarnation.
Source * SourceList::find_known(const Hint & hint) noexcept {
  const auto found = at_or_after(hint.publisher);
  const bool is_there = found != sources_.end() &&
                        hint.is_of(found->slot(), found->incarnation()) && found->is_current();
  return is_there ? &*found : nullptr;
}

std::vector<Source>::iterator SourceList::at_or_after(uint32_t slot) noexcept {
  return std::lower_bound(
    sources_.begin(), sources_.end(), slot,
    [](const Source & source, uint32_t wanted) { return source.slot() < wanted; });
}

}  // namespace manycore
