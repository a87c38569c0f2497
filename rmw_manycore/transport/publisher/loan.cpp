// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/publisher/loan.hpp"

#include <utility>

#include "transport/publisher/lent.hpp"

namespace manycore {

Loan::Loan(std::unique_ptr<Lent> lent) noexcept : lent_(std::move(lent)) {
  const TopicDsmWriter::Room room = lent_->publisher.writer.room_in(lent_->chunk);
  data_ = room.data;
  capacity_bytes_ = room.capacity_bytes;
}

Loan::Loan(Loan && other) noexcept = default;

Loan::~Loan() {
  if (lent_ != nullptr && !lent_->publisher.membership.is_inherited()) {
    const std::lock_guard lock(lent_->publisher.mutex);
    lent_->publisher.writer.give_back(lent_->chunk);
  }
}

}  // namespace manycore
