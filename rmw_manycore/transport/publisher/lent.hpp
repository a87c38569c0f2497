// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/publisher/loan.hpp"
#include "transport/publisher/publisher_impl.hpp"

namespace manycore {

struct Loan::Lent {
  Publisher::Impl & publisher;
  Block chunk;
};

}  // namespace manycore
