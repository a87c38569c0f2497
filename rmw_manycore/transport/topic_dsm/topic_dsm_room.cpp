// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of TopicDsmWriter: finds a descriptor for a record, and room for its bytes in the ring.

#include <algorithm>

#include "platform/error.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"
#include "virtual_time/door.hpp"

namespace manycore {
namespace {

/// Default max_blocking_time of Fast DDS.
constexpr int64_t max_blocking_ns = 100'000'000;

}  // namespace

void TopicDsmWriter::wait_for_progress(uint64_t number) {
  if (blocked_until_ns_ == 0) {
    blocked_until_ns_ = qos_now_ns() + max_blocking_ns;
  }
  if (qos_now_ns() >= blocked_until_ns_) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      ErrorCode::timeout,
      "publish on '" + std::string(endpoint_.topic) +
        "' timed out: RELIABLE + KEEP_ALL, and a subscription has not taken its messages for " +
        std::to_string(max_blocking_ns / 1'000'000) + " ms");
  }
  const uint32_t seen = dsm_.progress.load(std::memory_order_seq_cst);
  dsm_.writer_waits.store(1, std::memory_order_seq_cst);
  // Dekker with a reader that leaves: its row is closed before `writer_waits` is looked at.
  readers_.refresh(start());
  if (is_owed(number)) {
    registry_.tracer().note(TraceKind::blocked, dsm_.endpoint.load(), number);
    leave();  // no other process has to wait for this publisher's phase meanwhile
    const virtual_time::Door * const door = virtual_time::door();
    if (door == nullptr || !door->yield(true)) {
      futex_wait(dsm_.progress, seen, kernel_time_of(blocked_until_ns_));
    }
    enter();
  }
  dsm_.writer_waits.store(0, std::memory_order_relaxed);
  readers_.require_all(endpoint_.topic);  // the list is of another phase
}

void TopicDsmWriter::make_place(uint64_t number, uint64_t need_bytes) {
  if (!grow_to_hold_more(need_bytes)) {
    give_up(number);
  }
}

/// Waits for the readers of a record that is owed to them, or overwrites it.
void TopicDsmWriter::give_up(uint64_t number) {
  if (is_owed(number)) {
    wait_for_progress(number);
  } else {
    reclaim(number, true);
  }
}

/// Advances next_number_ to a number whose descriptor may be written. Numbers whose descriptor a
/// reader still has pinned are skipped: readers count losses by publication sequence number, not by
/// record number.
void TopicDsmWriter::claim_descriptor(uint64_t need_bytes) {
  const uint64_t max_skipped = current_.count * (readers_.all().size() + 1);
  for (uint64_t skipped = 0; skipped < max_skipped;) {
    RecordDescriptor & record = current_.descriptor(next_number_);
    const uint64_t old = record.number.load(std::memory_order_relaxed);
    if (old != no_record && &current_.descriptor(old) != &record) {
      // Damaged: no such number belongs here
      record.number.store(no_record, std::memory_order_seq_cst);
      continue;
    }
    if (old != no_record) {
      if (reclaim(old, false) == Reclaim::wanted) {
        make_place(old, need_bytes);
      }
      continue;
    }
    uint64_t & pinned = pinned_in_slot_[next_number_ & (current_.count - 1)];
    if (pinned == no_record || !readers_.is_pinned(pinned)) {
      pinned = no_record;
      return;
    }
    ++next_number_;
    ++skipped;
  }
  endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  throw Error(
    ErrorCode::no_space, "cannot publish on '" + std::string(endpoint_.topic) +
                           "': subscriptions are reading every record of its topic DSM");
}

/// Places a block of `need_bytes` at or after the cursor. False if wanted or pinned records leave
/// no room within one round.
bool TopicDsmWriter::try_place(uint64_t need_bytes) {
  // Each reader may in turn pin the very record that the cursor meets, but it tries to claim a
  // cleared record only once. That bounds the rounds.
  const size_t rounds = readers_.all().size() + 1;
  size_t pinned_seen = 0;
  size_t wraps = 0;
  while (true) {
    const bool ahead = !blocks_.empty() && blocks_.front().begin >= cursor_;
    const uint64_t limit = ahead ? blocks_.front().begin : current_.data_bytes;
    if (limit - cursor_ >= need_bytes) {
      blocks_.push_back({cursor_, cursor_ + need_bytes, next_number_});
      cursor_ += need_bytes;
      return true;
    }
    if (!ahead) {
      if (++wraps > rounds) {
        return false;
      }
      cursor_ = 0;
      continue;
    }
    const Block block = blocks_.front();
    switch (reclaim(block.number, false)) {
      case Reclaim::freed:
        blocks_.pop_front();
        break;
      case Reclaim::pinned:  // a hole: skipped now, met again in the next round
        if (++pinned_seen > blocks_.size() * rounds) {
          return false;
        }
        blocks_.pop_front();
        blocks_.push_back(block);
        cursor_ = block.end;
        break;
      case Reclaim::wanted: {
        const GenerationEntry * const before = current_.entry;
        make_place(block.number, need_bytes);
        wraps = current_.entry == before ? wraps : size_t{0};
        break;
      }
    }
  }
}

/// What each message begins with: memory that is free by now is taken back.
void TopicDsmWriter::prepare() {
  blocked_until_ns_ = 0;
  readers_.require_all(endpoint_.topic);
  if (!old_.empty()) {
    free_old_generations();
  }
  reclaim_free_records();
  free_idle_chunks();
}

TopicDsmWriter::Room TopicDsmWriter::find_room(uint64_t size_bytes) {
  prepare();
  if (goes_to_chunk(size_bytes)) {
    return find_chunk_room(size_bytes);
  }
  const uint64_t need = align_up(std::max<uint64_t>(size_bytes, 1), record_alignment);
  if (demand_.is_known()) {
    shrink(need);
  }
  require_data_bytes(need);
  claim_descriptor(need);
  if (
    !try_place(need) &&
    !(grow(std::max(current_.data_bytes, need) * 2, current_.count) && try_place(need))) {
    endpoint_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    throw Error(
      ErrorCode::no_space,
      "the topic DSM of '" + std::string(endpoint_.topic) +
        "' is full of records that are being read; a message of " + std::to_string(size_bytes) +
        " bytes needs a topic_dsm_size of at least " + std::to_string(current_.data_bytes + need));
  }
  demand_.note(held_records(), blocks_.bytes());
  const Block & block = blocks_.back();
  return {cluster_.find<uint8_t>(current_.data_offset) + block.begin, block.end - block.begin};
}

void TopicDsmWriter::abandon_room() noexcept {
  if (std::exchange(is_chunk_in_work_, false)) {
    chunks_.put_back_newest();
    return;
  }
  cursor_ = blocks_.back().begin;
  blocks_.pop_back();
}

}  // namespace manycore
