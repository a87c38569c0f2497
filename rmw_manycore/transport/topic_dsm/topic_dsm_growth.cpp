// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The part of TopicDsmWriter that adds generations and gives old ones back.

#include <algorithm>
#include <utility>

#include "platform/error.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {
namespace {

constexpr uint64_t descriptor_limit = 1 << 16;
constexpr uint64_t many_bytes = 16 << 20;
constexpr uint64_t least_worth_bytes = 16 << 10;  ///< a smaller ring does not shrink

uint64_t half_as_much_again(uint64_t bytes) { return align_up(bytes * 3 / 2, record_alignment); }

}  // namespace

/// Takes back what no reader wants in an old generation, from its oldest record to the first that
/// is wanted; true when nothing is left. A deep history is so looked at once, and not at each
/// publish.
bool TopicDsmWriter::drain(Generation & old) {
  for (; old.drained_before < old.end; ++old.drained_before) {
    const uint64_t number = old.drained_before;
    RecordDescriptor & record = old.descriptor(number);
    if (record.number.load(std::memory_order_relaxed) != number) {
      continue;
    }
    if (is_wanted(number, record)) {
      return false;
    }
    record.number.store(no_record, std::memory_order_seq_cst);
  }
  return true;
}

/// Closes an old generation once nothing is left in it; true when no reader looks into it any more.
/// Under the lock: a sweeper that holds it may look as well.
bool TopicDsmWriter::retire(Generation & old) {
  if (old.entry->first.load(std::memory_order_relaxed) != 0) {
    if (!drain(old)) {
      return false;
    }
    const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
    // Dekker with the claim: the reader stores `reading` before it loads `first`. A reader that
    // joined just now counts too, so the list is renewed after the store.
    old.entry->first.store(0, std::memory_order_seq_cst);
  }
  readers_.refresh();
  // A reader that looks for a record of a younger generation, closed by now, may have come to this
  // one.
  return !readers_.is_any_pinned(old.first, current_.first - 1);
}

/// The memory goes back to the system a step at each message, and then the SMEM to the cluster.
/// Under the lock, which a killed process gives back only when its system call has ended: it makes
/// no hole where the memory is another's by then.
void TopicDsmWriter::free_old_generations() noexcept {
  try {
    for (size_t i = 0; i < old_.size();) {
      Generation & old = old_[i];
      if (!retire(old)) {
        ++i;
        continue;
      }
      const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
      if (!old.release_some(cluster_)) {
        ++i;
        continue;
      }
      Generation::free(cluster_, *old.entry);
      old_.erase(old_.begin() + static_cast<ptrdiff_t>(i));
    }
  } catch (const Error &) {
    // Another process holds the registry lock: the next publish tries again.
  }
}

uint64_t TopicDsmWriter::data_limit() const noexcept {
  return endpoint_.topic_dsm_size != 0 ? current_.data_bytes : cluster_.size() / 2;
}

/// Of a message that needs the room, or would displace another, more would be lost than time, so
/// the lock is waited for while its owners run. A process that stands still holding it must not
/// hold up each record, nor each publish: no hold is waited for twice.
Registry::Lock TopicDsmWriter::lock_to_grow() {
  if (registry_.header().changes.load() == waited_for_) {
    return Registry::Lock(registry_, Registry::Lock::no_wait_ns);
  }
  try {
    return {registry_, Registry::Lock::WhileOwnersRun{}};
  } catch (const Error &) {
    waited_for_ = registry_.header().changes.load();
    throw;
  }
}

void TopicDsmWriter::reserve_generation(
  GenerationEntry & entry, uint64_t data_bytes, uint64_t descriptor_count) {
  const uint64_t extent = Generation::extent_bytes(data_bytes, descriptor_count);
  if (extent <= current_.entry->extent_bytes()) {  // a smaller one makes room in the end
    const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
    Generation::reserve(cluster_, entry, data_bytes, descriptor_count);
    return;
  }
  const Registry::Lock lock = lock_to_grow();
  cluster_.require_message_room(extent);
  Generation::reserve(cluster_, entry, data_bytes, descriptor_count);
}

/// Without the lock, which others want meanwhile. The entry holds the reservation, for a reaper to
/// undo.
void TopicDsmWriter::open_generation(GenerationEntry & entry) {
  try {
    if (entry.extent_bytes() > current_.entry->extent_bytes()) {
      cluster_.require_file_system_room(entry.extent_bytes());
    }
    Generation::open(cluster_, entry, next_number_);
  } catch (const Error &) {
    free_unopened(entry);
    throw;
  }
}

/// Where the lock is not to be had it counts as an old generation, without records.
void TopicDsmWriter::free_unopened(GenerationEntry & entry) {
  try {
    const Registry::Lock lock(registry_, Registry::Lock::short_wait_ns);
    Generation::free(cluster_, entry);
  } catch (const Error &) {
    old_.push_back(Generation::view(cluster_, entry));
    old_.back().first = next_number_;
  }
}

bool TopicDsmWriter::grow(uint64_t data_bytes, uint64_t descriptor_count) {
  try {
    return add_generation(data_bytes, descriptor_count);
  } catch (const Error &) {
    return false;
  }
}

bool TopicDsmWriter::add_generation(uint64_t data_bytes, uint64_t descriptor_count) {
  const bool larger = data_bytes > current_.data_bytes || descriptor_count > current_.count;
  if (
    endpoint_.topic_dsm_size != 0 || !larger || data_bytes > data_limit() ||
    descriptor_count > most_descriptors() || !start_generation(data_bytes, descriptor_count)) {
    return false;
  }
  demand_.note_grown();
  return true;
}

bool TopicDsmWriter::start_generation(uint64_t data_bytes, uint64_t descriptor_count) {
  GenerationEntry * const free_entry = std::find_if(
    std::begin(dsm_.generations), std::end(dsm_.generations),
    [](const GenerationEntry & entry) { return entry.offset.load() == 0; });
  if (free_entry == std::end(dsm_.generations)) {
    return false;
  }
  if (next_number_ == current_.first) {
    ++next_number_;  // a reader tells generations apart by their first numbers
  }
  // Without memory for these nothing is begun: readers would look where no record goes.
  std::vector<uint64_t> pinned(descriptor_count, no_record);
  old_.reserve(old_.size() + 1);
  reserve_generation(*free_entry, data_bytes, descriptor_count);
  open_generation(*free_entry);
  old_.push_back(current_);
  old_.back().end = next_number_;
  old_.back().drained_before = next_number_ - std::min(next_number_, current_.count);
  current_ = Generation::view(cluster_, *free_entry);
  blocks_.clear();
  pinned_in_slot_ = std::move(pinned);
  cursor_ = 0;
  return true;
}

/// Twice of what was used, if that is half of what there is: a ring that is in use as it was for
/// the last messages neither grows nor shrinks.
void TopicDsmWriter::shrink(uint64_t need_bytes) noexcept {
  demand_.note(blocks_.size() + 1, blocks_.bytes() + need_bytes);
  const uint64_t bytes = std::max(first_data_bytes, 2 * demand_.bytes());
  const uint64_t records =
    std::max(first_descriptor_count, power_of_two_at_least(2 * demand_.records()));
  demand_.start_over();
  const uint64_t extent = current_.entry->extent_bytes();
  if (
    endpoint_.topic_dsm_size != 0 || !old_.empty() || extent < least_worth_bytes ||
    Generation::extent_bytes(bytes, records) > extent / 2) {
    return;
  }
  try {
    if (start_generation(bytes, std::min(records, current_.count))) {
      demand_.note_shrunk();
    }
  } catch (const std::exception &) {
    // The registry is locked, or there is no room for both: it is tried again.
  }
}

uint64_t TopicDsmWriter::most_descriptors() const noexcept {
  return dsm_.keep_all != 0 ? keep_all_capacity : descriptor_limit;
}

/// The most records that are wanted at a time. Each reply is for one client, so theirs add up.
uint64_t TopicDsmWriter::deepest_history() const noexcept {
  uint64_t deepest = dsm_.transient_local != 0 ? dsm_.depth : 1;
  for (const Reader & reader : readers_.readers()) {
    const bool unbounded = reader.subscription->keep_all != 0 || dsm_.keep_all != 0;
    const uint64_t wanted = unbounded ? keep_all_capacity : reader.subscription->depth;
    deepest = endpoint_.role == EndpointRole::reply ? deepest + wanted : std::max(deepest, wanted);
  }
  return deepest;
}

/// Four times the records, descriptors and bytes alike, but no more than are ever wanted: few
/// generations, since the old ones stay while their records are wanted. Twice the records where
/// they are many bytes. Half as many bytes more at least: records of mixed sizes leave gaps.
bool TopicDsmWriter::grow_to_hold_more(uint64_t need_bytes) {
  const uint64_t held = std::max<uint64_t>(blocks_.size(), 1);
  const uint64_t bytes_per_record = std::max(need_bytes, blocks_.bytes() / held);
  const uint64_t factor = held * bytes_per_record < many_bytes ? 4 : 2;
  const uint64_t records =
    std::max(held + factor / 2, std::min(held * factor, deepest_history() + 2));
  const uint64_t bytes = std::max(
    align_up(records * bytes_per_record, record_alignment),
    half_as_much_again(current_.data_bytes));
  return grow(
    std::min(bytes, std::max(data_limit(), current_.data_bytes)),
    std::clamp(power_of_two_at_least(records), current_.count, most_descriptors()));
}

/// Room for such a message, and where there is any for half as much again as there was: messages
/// that become larger bit by bit would else each add a generation.
bool TopicDsmWriter::add_generation_for(uint64_t need_bytes) {
  try {
    const uint64_t more = std::min(half_as_much_again(current_.data_bytes), data_limit());
    return add_generation(std::max(need_bytes, more), current_.count);
  } catch (const Error & error) {
    if (error.code() != ErrorCode::no_space) {
      throw;
    }
  }
  return add_generation(need_bytes, current_.count);
}

void TopicDsmWriter::require_data_bytes(uint64_t need_bytes) {
  if (need_bytes > UINT32_MAX) {  // of RecordDescriptor::size_bytes
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      ErrorCode::too_large, "a message of " + std::to_string(need_bytes) + " bytes on '" +
                              endpoint_.topic +
                              "' is larger than 4 GiB, the most that a record holds");
  }
  if (need_bytes <= current_.data_bytes) {
    return;
  }
  const std::string size = std::to_string(need_bytes);
  try {
    if (add_generation_for(need_bytes)) {
      return;
    }
  } catch (const Error & error) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      error.code() == ErrorCode::no_space ? ErrorCode::too_large : error.code(),
      "a message of " + size + " bytes on '" + endpoint_.topic +
        "' needs a larger topic DSM, but " + error.what());
  }
  endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  if (endpoint_.topic_dsm_size != 0) {
    throw Error(
      ErrorCode::too_large, "a message of " + size + " bytes does not fit the topic DSM of '" +
                              endpoint_.topic + "' (" + std::to_string(endpoint_.topic_dsm_size) +
                              " bytes); set its topic_dsm_size to at least " + size);
  }
  throw Error(
    ErrorCode::too_large,
    "a message of " + size + " bytes on '" + std::string(endpoint_.topic) +
      "' does not fit into cluster " + std::to_string(cluster_.id()) + ": " +
      std::to_string(cluster_.used_bytes()) + " of " + std::to_string(cluster_.size()) +
      " bytes of SMEM are used; it needs at least " + size + " free (is /dev/shm large enough?)");
}

}  // namespace manycore
