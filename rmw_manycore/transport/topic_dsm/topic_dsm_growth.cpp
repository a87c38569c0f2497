// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of TopicDsmWriter: adds generations and frees old ones.

#include <algorithm>
#include <utility>

#include "platform/error.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {
namespace {

constexpr uint64_t descriptor_limit = 1 << 16;
constexpr uint64_t mebibyte = 1 << 20;
constexpr uint64_t many_bytes = 16 * mebibyte;
constexpr uint64_t min_shrinking_bytes = 16 << 10;  ///< smaller rings do not shrink

uint64_t half_as_much_again(uint64_t bytes) { return align_up(bytes * 3 / 2, record_alignment); }

}  // namespace

/// Takes back the records of an old generation that no reader wants, from the oldest to the first
/// wanted one. True when none is left. `drained_before` keeps the position, so a deep history is
/// checked once, not once per publish.
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

/// Closes an old generation once it is drained. True when no reader accesses it any more.
bool TopicDsmWriter::retire(Generation & old) {
  if (old.is_unread) {
    return true;
  }
  if (old.entry->first.load(std::memory_order_relaxed) != 0) {
    if (!drain(old)) {
      return false;
    }
    // Dekker with the claim: the reader stores `reading` before it loads `first`. Rebuild the
    // reader list after the store, so that a reader that has just joined is checked as well.
    old.entry->first.store(0, std::memory_order_seq_cst);
  }
  readers_.refresh(start());
  // A reader on its way to a record of a younger, closed generation may have reached this one. A
  // header-only reader pins none.
  old.is_unread = !readers_.is_any_pinned(old.first, current_.first - 1);
  return old.is_unread;
}

void TopicDsmWriter::free_old_generations() noexcept {
  try {
    for (size_t i = 0; i < old_.size();) {
      if (retire(old_[i]) && free_generation(*old_[i].entry)) {
        old_.erase(old_.begin() + static_cast<ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  } catch (const std::exception &) {
    // Another process holds the registry lock, or memory is short; the next publish tries again.
  }
}

/// False while another thread of this process makes or frees a block.
bool TopicDsmWriter::free_generation(GenerationEntry & entry) {
  std::optional<BlockInHand> hand = BlockInHand::try_make(registry_);
  if (hand) {
    const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
    Generation::take_up(cluster_, entry, *hand);
  }
  return hand.has_value();
}

uint64_t TopicDsmWriter::data_limit() const noexcept {
  return endpoint_.topic_dsm_size != 0 ? current_.data_bytes : cluster_.size() / 2;
}

/// A message that would be refused, or would displace another one, is worth more than the time to
/// wait for the lock, so wait while its owners run. A stopped owner must not delay each record, nor
/// each publish: the same hold is waited for only once.
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
  if (extent <= current_.entry->extent_bytes()) {  // shrinking releases memory in the end
    const Registry::Lock lock(registry_, Registry::Lock::no_wait_ns);
    Generation::reserve(cluster_, entry, data_bytes, descriptor_count);
    return;
  }
  const Registry::Lock lock = lock_to_grow();
  cluster_.require_message_room(extent);
  Generation::reserve(cluster_, entry, data_bytes, descriptor_count);
}

/// Without the registry lock, so that other processes can take it. If this process dies, the reaper
/// finds the reservation in the entry.
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

/// If the lock is not available, the entry is kept as an old generation without records.
void TopicDsmWriter::free_unopened(GenerationEntry & entry) {
  try {
    if (free_generation(entry)) {
      return;
    }
  } catch (const Error &) {
    // Another process holds the registry lock.
  }
  old_.push_back(Generation::view(cluster_, entry));
  old_.back().first = next_number_;
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
    descriptor_count > max_descriptors() || !start_generation(data_bytes, descriptor_count)) {
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
    ++next_number_;  // readers tell generations apart by their first numbers
  }
  // Allocate before anything changes: readers would look into a generation that gets no record.
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

/// New size: twice the peak usage, if that is at most half of the present size. A ring whose usage
/// stays the same neither grows nor shrinks.
void TopicDsmWriter::shrink(uint64_t need_bytes) noexcept {
  demand_.note(held_records() + 1, blocks_.bytes() + need_bytes);
  const uint64_t bytes = std::max(first_data_bytes, 2 * demand_.bytes());
  const uint64_t records =
    std::max(first_descriptor_count, power_of_two_at_least(2 * demand_.records()));
  demand_.start_over();
  const uint64_t extent = current_.entry->extent_bytes();
  if (
    endpoint_.topic_dsm_size != 0 || !old_.empty() || extent < min_shrinking_bytes ||
    Generation::extent_bytes(bytes, records) > extent / 2) {
    return;
  }
  try {
    if (start_generation(bytes, std::min(records, current_.count))) {
      demand_.note_shrunk();
    }
  } catch (const std::exception &) {
    // The registry is locked, or there is no room for both generations. A later publish tries
    // again.
  }
}

uint64_t TopicDsmWriter::max_descriptors() const noexcept {
  return dsm_.keep_all != 0 ? keep_all_capacity : descriptor_limit;
}

/// Number of records that may be wanted at a time. Each reply is for one client, so their depths
/// add up.
uint64_t TopicDsmWriter::deepest_history() const noexcept {
  uint64_t deepest = dsm_.transient_local != 0 ? dsm_.depth : 1;
  for (const Reader & reader : readers_.all()) {
    const bool unbounded = reader.subscription->keep_all != 0 || dsm_.keep_all != 0;
    const uint64_t wanted = unbounded ? keep_all_capacity : reader.subscription->depth;
    deepest = endpoint_.role == EndpointRole::reply ? deepest + wanted : std::max(deepest, wanted);
  }
  return deepest;
}

/// New capacity: four times the records, in descriptors and bytes, but no more than are ever
/// wanted. Few generations result, because old ones stay while their records are wanted. Only twice
/// the records if they are large. At least half as many bytes again, because records of mixed sizes
/// leave gaps.
bool TopicDsmWriter::grow_to_hold_more(uint64_t need_bytes) {
  const uint64_t held = std::max<uint64_t>(held_records(), 1);
  const uint64_t in_ring = std::max<uint64_t>(blocks_.size(), 1);
  const uint64_t bytes_per_record = std::max(need_bytes, blocks_.bytes() / in_ring);
  const uint64_t factor = held * bytes_per_record < many_bytes ? 4 : 2;
  const uint64_t records =
    std::max(held + factor / 2, std::min(held * factor, deepest_history() + 2));
  const uint64_t bytes = std::max(
    align_up(records * bytes_per_record, record_alignment),
    half_as_much_again(current_.data_bytes));
  return grow(
    std::min(bytes, std::max(data_limit(), current_.data_bytes)),
    std::clamp(power_of_two_at_least(records), current_.count, max_descriptors()));
}

/// Asks for half as much again as there is now, if the limit allows it; otherwise for this message
/// only. Messages that grow little by little would otherwise add a generation each.
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
  if (need_bytes <= current_.data_bytes) {
    return;
  }
  try {
    if (need_bytes <= UINT32_MAX && add_generation_for(need_bytes)) {
      return;
    }
  } catch (const Error & error) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    const bool is_full = error.code() == ErrorCode::no_space;
    throw Error(
      is_full ? ErrorCode::too_large : error.code(),
      message_text(need_bytes) + " needs a larger topic DSM, but " +
        (is_full && !old_.empty() ? holders_text() + ", and " : "") + error.what());
  }
  endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  throw Error(ErrorCode::too_large, message_text(need_bytes) + refusal_text(need_bytes));
}

std::string TopicDsmWriter::message_text(uint64_t need_bytes) const {
  return "a message of " + std::to_string(need_bytes) + " bytes on '" + endpoint_.topic + "'";
}

/// Names what keeps old generations: messages not yet taken, or still being read.
std::string TopicDsmWriter::holders_text() const {
  uint64_t bytes = 0;
  for (const Generation & old : old_) {
    bytes += old.entry->extent_bytes();
  }
  return "subscriptions hold messages of " + std::to_string(old_.size()) +
         " earlier sizes of it, " + std::to_string(bytes) + " bytes, not taken or being read";
}

/// Why add_generation_for() adds none, and what helps.
std::string TopicDsmWriter::refusal_text(uint64_t need_bytes) const {
  if (need_bytes > UINT32_MAX) {  // limit of RecordDescriptor::size_bytes
    return " is larger than 4 GiB, the maximum size of a record";
  }
  const std::string own_size = "its topic_dsm_size to at least " + std::to_string(need_bytes);
  if (endpoint_.topic_dsm_size != 0) {
    return " does not fit its topic DSM of " + std::to_string(endpoint_.topic_dsm_size) +
           " bytes; set " + own_size;
  }
  if (need_bytes <= data_limit()) {
    return " needs a larger topic DSM, but " + holders_text() + "; take them, or set " + own_size;
  }
  const uint64_t helps = align_up(2 * need_bytes, mebibyte);
  return " does not fit: a topic DSM grows to at most half of the SMEM of its cluster, which has " +
         std::to_string(cluster_.size()) + " bytes; in a mapfile, set smem_size to at least " +
         std::to_string(helps) + (need_bytes < cluster_.size() ? ", or " + own_size : "") +
         "; without a mapfile, SMEM follows the size of /dev/shm";
}

}  // namespace manycore
