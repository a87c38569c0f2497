// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "message_type.hpp"

using Random = std::mt19937_64;

/// A number from `first` to `last`.
uint64_t choose(Random & random, uint64_t first, uint64_t last);

/// The CDR of a message, and where in it the lengths of strings and sequences stand.
struct Sample {
  std::vector<uint8_t> cdr;
  std::vector<size_t> lengths;
};

/// A valid message with values made up.
Sample make_sample(const Members & type, Random & random);

/// Changes some bytes: lengths above all, since memory is reserved by them.
void mutate(Sample & sample, Random & random);
