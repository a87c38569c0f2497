// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "message_type.hpp"

using Random = std::mt19937_64;

/// A random number from `first` to `last`.
uint64_t choose(Random & random, uint64_t first, uint64_t last);

/// CDR of a message, and the positions of its string and sequence lengths.
struct Sample {
  std::vector<uint8_t> cdr;
  std::vector<size_t> lengths;
};

/// A valid message with random values.
Sample make_sample(const Members & type, Random & random);

/// Changes some bytes: preferably lengths, because memory is reserved for them.
void mutate(Sample & sample, Random & random);
