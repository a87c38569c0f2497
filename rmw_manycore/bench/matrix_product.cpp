// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long does C = A x B take on pinned processes?
//
//   matrix_product n=N threads=N clusters=N memory=ddr|smem evicted=0|1 cpus=A,B,...
//     warm_up=N iterations=N
//
// clusters=0: `threads` workers compute rows of C, all in the same memory.
// clusters=4: off-loading; to each cluster goes a tile of A and one of B, `threads` workers of the
//   cluster compute a quarter of C in its own memory, and the tiles of C are collected.
// ddr: ordinary memory, flushed before each product; smem: shared memory, just written.
// evicted: each row of B is flushed after use, the nearest that user space comes to uncached
// memory. Every element is a sum in the order of its terms, so C has the same bits for every split;
// its `checksum` is printed, with how many of the `samples_ns` were spent in copies (`copy_ns`).
#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "bench/flush.hpp"
#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

/// A part of a product: rows of A, columns of B, and C; each in a memory of its own.
struct Tile {
  const float * a;
  const float * b;
  float * c;
  size_t rows;
  size_t columns;
  size_t depth;
};

float * matrix_memory(size_t elements) {
  return reinterpret_cast<float *>(shared_memory(elements * sizeof(float)));
}

void multiply_rows(const Tile & tile, size_t first, size_t last, bool is_evicted) {
  for (size_t i = first; i < last; ++i) {
    float * const row = tile.c + i * tile.columns;
    std::fill(row, row + tile.columns, 0.0F);
    for (size_t k = 0; k < tile.depth; ++k) {
      const float factor = tile.a[i * tile.depth + k];
      const float * const other = tile.b + k * tile.columns;
      for (size_t j = 0; j < tile.columns; ++j) {
        row[j] += factor * other[j];
      }
      if (is_evicted) {
        flush(other, tile.columns * sizeof(float));
      }
    }
  }
}

/// A worker: sleeps until product `number` is ordered, computes its rows, and reports it.
struct Worker {
  Slot * order;
  Slot * done;
};

Worker start_worker(
  const Tile & tile, size_t part, size_t parts, size_t cpu, bool is_evicted, size_t products) {
  const Worker worker{&Slot::create(0), &Slot::create(0)};
  fork_on(cpu, [&] {
    for (uint32_t number = 1; number <= products; ++number) {
      worker.order->wait_for(number);
      const size_t first = tile.rows * part / parts;
      multiply_rows(tile, first, tile.rows * (part + 1) / parts, is_evicted);
      worker.done->announce(number);
    }
  });
  return worker;
}

void run_all(const std::vector<Worker> & workers, uint32_t number) {
  for (const Worker & worker : workers) {
    worker.order->announce(number);
  }
  for (const Worker & worker : workers) {
    worker.done->wait_for(number);
  }
}

/// The matrices, and the quarters of them that clusters have.
class Product {
public:
  Product(size_t n, size_t clusters)
  : n_(n), a_(matrix_memory(n * n)), b_(matrix_memory(n * n)), c_(matrix_memory(n * n)) {
    for (size_t i = 0; i < n * n; ++i) {
      a_[i] = static_cast<float>(i % 97) / 97.0F - 0.5F;
      b_[i] = static_cast<float>(i % 89) / 89.0F - 0.5F;
    }
    for (size_t quarter = 0; quarter < clusters; ++quarter) {
      const size_t rows = rows_of(quarter / 2);
      const size_t columns = rows_of(quarter % 2);
      tiles_.push_back(
        {matrix_memory(rows * n), matrix_memory(n * columns), matrix_memory(rows * columns), rows,
         columns, n});
    }
    if (clusters == 0) {
      tiles_.push_back({a_, b_, c_, n, n, n});
    }
  }

  const std::vector<Tile> & tiles() const { return tiles_; }

  void prepare(bool in_ddr) {
    if (in_ddr) {
      flush(a_, n_ * n_ * sizeof(float));
      flush(b_, n_ * n_ * sizeof(float));
    }
    std::fill(c_, c_ + n_ * n_, -1.0F);
  }

  void distribute() {
    for (size_t quarter = 0; quarter < tiles_.size(); ++quarter) {
      const Tile & tile = tiles_[quarter];
      std::memcpy(
        const_cast<float *>(tile.a), a_ + start_of(quarter / 2) * n_,
        tile.rows * n_ * sizeof(float));
      for (size_t k = 0; k < n_; ++k) {
        std::memcpy(
          const_cast<float *>(tile.b) + k * tile.columns, b_ + k * n_ + start_of(quarter % 2),
          tile.columns * sizeof(float));
      }
    }
  }

  void collect() {
    for (size_t quarter = 0; quarter < tiles_.size(); ++quarter) {
      const Tile & tile = tiles_[quarter];
      for (size_t i = 0; i < tile.rows; ++i) {
        std::memcpy(
          c_ + (start_of(quarter / 2) + i) * n_ + start_of(quarter % 2), tile.c + i * tile.columns,
          tile.columns * sizeof(float));
      }
    }
  }

  /// FNV-1a over the bits of C.
  uint64_t checksum() const {
    uint64_t sum = 14695981039346656037ULL;
    for (size_t i = 0; i < n_ * n_; ++i) {
      uint32_t bits = 0;
      std::memcpy(&bits, c_ + i, sizeof bits);
      sum = (sum ^ bits) * 1099511628211ULL;
    }
    return sum;
  }

private:
  size_t start_of(size_t half) const { return half == 0 ? 0 : n_ / 2; }
  size_t rows_of(size_t half) const { return half == 0 ? n_ / 2 : n_ - n_ / 2; }

  size_t n_;
  float * a_;
  float * b_;
  float * c_;
  std::vector<Tile> tiles_;
};

void run(const Arguments & arguments) {
  const size_t n = arguments.number("n");
  const size_t threads = arguments.number("threads");
  const size_t clusters = arguments.number("clusters");
  const bool is_evicted = arguments.number("evicted") != 0;
  const bool in_ddr = arguments.text("memory") == "ddr";
  const size_t warm_up = arguments.number("warm_up");
  const std::vector<std::string> cpus = arguments.list("cpus");
  if (n < 2 || threads == 0 || (clusters != 0 && clusters != 4) || cpus.empty()) {
    throw std::invalid_argument("expected n >= 2, threads >= 1, clusters=0 or 4, and cpus");
  }
  std::vector<int64_t> samples_ns(warm_up + arguments.number("iterations"));
  Product product(n, clusters);
  std::vector<Worker> workers;
  for (const Tile & tile : product.tiles()) {
    for (size_t part = 0; part < threads; ++part) {
      const size_t cpu = std::stoul(cpus[workers.size() % cpus.size()]);
      workers.push_back(start_worker(tile, part, threads, cpu, is_evicted, samples_ns.size()));
    }
  }
  int64_t copy_ns = 0;
  for (uint32_t i = 0; i < samples_ns.size(); ++i) {
    product.prepare(in_ddr);
    const int64_t start_ns = monotonic_ns();
    if (clusters != 0) {
      product.distribute();
    }
    const int64_t ordered_ns = monotonic_ns();
    run_all(workers, i + 1);
    const int64_t computed_ns = monotonic_ns();
    if (clusters != 0) {
      product.collect();
    }
    const int64_t end_ns = monotonic_ns();
    samples_ns[i] = end_ns - start_ns;
    copy_ns += i < warm_up ? 0 : end_ns - computed_ns + ordered_ns - start_ns;
  }
  wait_for_children();
  drop_warm_up(samples_ns, warm_up);
  const uint64_t mean_copy_ns = static_cast<uint64_t>(copy_ns) / samples_ns.size();
  print_samples(samples_ns, {{"checksum", product.checksum()}, {"copy_ns", mean_copy_ns}});
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
