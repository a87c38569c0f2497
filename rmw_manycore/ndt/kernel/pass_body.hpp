// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The hot loops, for any instruction set. Included by pass_<simd>.cpp inside its own namespace,
// after that file has defined `Lanes`:
//   width                 lanes of a register: the points of a group
//   F, I                  registers of floats and of 32-bit integers, with C's operators
//   M                     mask of lanes
//   load, set1            of floats
//   sum                   of the lanes: the halves, their halves and so on
//   to_int, to_float      truncating, exact
//   fma(a, b, c)          a * b + c, fused where the CPU can
//   min, max              the second operand where one is not a number
//   less_equal(a, b)      mask of the lanes where a <= b
//   equal(a, i)           mask of the lanes of integers that are i
//   bits(m)               lane i of a mask as bit i
//   only(m, f)            f in the lanes of a mask, else 0
//   put(into, m, f)       f in the lanes of a mask, else those of `into`
//   shift_exponent(f, n)  f * 2^n

using F = Lanes::F;
using I = Lanes::I;
static_assert(Lanes::width == group_points);

/// Fields of a voxel line: mean, weight, inverse covariance.
constexpr size_t line_fields = 10;

/// Constants of a pass, one value per lane.
struct Constants {
  F rotation[9];
  F translation[3];
  F inverse_size;
  F first_cell[3];
  F last_cell[3];
  F squared_size;
  F exponent;  // base 2, per unit of x'Bx: -d2 / 2 / ln 2
  F minus_d2;
  int32_t cells_x;
  int32_t cells_y;
};

Constants constants_of(const MapHeader & map, const PassPose & pose, float d2) {
  Constants c;
  for (size_t i = 0; i < 9; ++i) {
    c.rotation[i] = Lanes::set1(pose.rotation[i]);
  }
  for (size_t i = 0; i < 3; ++i) {
    c.translation[i] = Lanes::set1(pose.translation_m[i]);
    c.first_cell[i] = Lanes::set1(static_cast<float>(map.first_cell[i]));
    c.last_cell[i] = Lanes::set1(static_cast<float>(map.cells[i] - 1));
  }
  const float size = static_cast<float>(map.voxel_size_m);
  c.inverse_size = Lanes::set1(static_cast<float>(1 / map.voxel_size_m));
  c.squared_size = Lanes::set1(size * size);
  c.exponent = Lanes::set1(-0.5F * 1.44269504F * d2);
  c.minus_d2 = Lanes::set1(-d2);
  c.cells_x = map.cells[0];
  c.cells_y = map.cells[1];
  return c;
}

/// 2^x for x <= 0, accurate to 2e-7; 0 below 2^-126. Taylor polynomial of 2^r on [-1/2, 1/2].
inline F exp2_negative(const F & x) {
  const F bounded = Lanes::max(x, Lanes::set1(-126));
  const I n = Lanes::to_int(bounded - Lanes::set1(0.5F));
  const F r = bounded - Lanes::to_float(n);
  F p = Lanes::set1(1.5403530e-4F);
  p = Lanes::fma(p, r, Lanes::set1(1.3333558e-3F));
  p = Lanes::fma(p, r, Lanes::set1(9.6181291e-3F));
  p = Lanes::fma(p, r, Lanes::set1(5.5504109e-2F));
  p = Lanes::fma(p, r, Lanes::set1(2.4022651e-1F));
  p = Lanes::fma(p, r, Lanes::set1(6.9314718e-1F));
  p = Lanes::fma(p, r, Lanes::set1(1));
  return Lanes::only(Lanes::less_equal(Lanes::set1(-126), x), Lanes::shift_exponent(p, n));
}

/// Lanes whose points lie in one cell, and so see the same voxels: on average a group of recorded
/// scans is in two cells. A voxel that several lanes see is read once.
struct InCell {
  Lanes::M lanes;
  const uint32_t * list;  // of the voxels that are left
};

/// One point per lane: rotated into the map frame (q), and the cells of those that see a voxel.
struct Sight {
  F q[3];
  F p[3];  // q translated, relative to the map's origin
  InCell cells[Lanes::width];
  size_t cell_count = 0;
};

/// Calls visit(lanes, id) for each id among the lanes.
template<typename Visit>
inline void for_each_id(const I & id, Visit visit) {
  int32_t ids[Lanes::width];
  std::memcpy(ids, &id, sizeof ids);
  constexpr uint32_t all = (uint32_t{1} << Lanes::width) - 1;
  for (uint32_t left = all; left != 0;) {
    const int32_t next = ids[__builtin_ctz(left)];
    const Lanes::M lanes = Lanes::equal(id, next);
    left &= ~Lanes::bits(lanes);
    visit(lanes, static_cast<uint32_t>(next));
  }
}

/// Looks up the voxel lists in the map's table.
struct LookUp {
  I ids(size_t, const I & key) const { return key; }
  uint32_t list(const MapView & map, uint32_t key) const { return find_list(map, key); }
};

/// Uses voxel lists found by an earlier search().
struct Found {
  const uint32_t * list_of_point;

  I ids(size_t first, const I &) const {
    I lists;
    std::memcpy(&lists, list_of_point + first, sizeof lists);
    return lists;
  }
  uint32_t list(const MapView &, uint32_t found) const { return found; }
};

template<typename Find>
inline Sight look(
  const MapView & map, const ScanView & scan, const Constants & c, size_t first, Find find) {
  Sight s;
  const F x = Lanes::load(scan.x_m + first);
  const F y = Lanes::load(scan.y_m + first);
  const F z = Lanes::load(scan.z_m + first);
  I cell[3];
  for (size_t i = 0; i < 3; ++i) {
    const F * const row = c.rotation + 3 * i;
    s.q[i] = Lanes::fma(row[0], x, Lanes::fma(row[1], y, row[2] * z));
    s.p[i] = s.q[i] + c.translation[i];
    // Points outside the grid are clamped to its border, which is in no table. Cells are counted
    // from 0, so truncation rounds down.
    const F place = Lanes::fma(s.p[i], c.inverse_size, -c.first_cell[i]);
    cell[i] = Lanes::to_int(Lanes::min(Lanes::max(place, Lanes::set1(0)), c.last_cell[i]));
  }
  const I key = cell[0] + (cell[1] + cell[2] * c.cells_y) * c.cells_x;
  for_each_id(find.ids(first, key), [&](const Lanes::M & lanes, uint32_t id) {
    const uint32_t list = find.list(map, id);
    if (list != empty_list) {
      s.cells[s.cell_count++] = {lanes, map.lists + list};
    }
  });
  return s;
}

/// Moves fields of the next voxel of each cell into its lanes; the other lanes become zero, and so
/// weigh nothing.
template<size_t from, size_t to>
inline void load_fields(const MapView & map, const Sight & s, F (&fields)[line_fields]) {
  const float * line = map.lines[*s.cells[0].list].mean_m;
  for (size_t field = from; field < to; ++field) {
    fields[field] = Lanes::only(s.cells[0].lanes, Lanes::set1(line[field]));
  }
  for (size_t i = 1; i < s.cell_count; ++i) {
    line = map.lines[*s.cells[i].list].mean_m;
    for (size_t field = from; field < to; ++field) {
      fields[field] = Lanes::put(fields[field], s.cells[i].lanes, Lanes::set1(line[field]));
    }
  }
}

/// Moves each cell to its next voxel, and drops those that have no more.
inline void advance(Sight & s) {
  for (size_t i = s.cell_count; i-- > 0;) {
    if (*++s.cells[i].list == 0) {
      s.cells[i] = s.cells[--s.cell_count];
    }
  }
}

template<size_t count>
inline void clear(F (&sums)[count]) {
  for (F & sum : sums) {
    sum = Lanes::set1(0);
  }
}

/// Sums over the voxels of each lane's point, without the factors of q.
struct PointSums {
  F score = Lanes::set1(0);
  F nearest = Lanes::set1(0);
  F pairs = Lanes::set1(0);
  F f[3];
  F m[6];

  PointSums() {
    clear(f);
    clear(m);
  }
};

template<bool by_radius>
inline void add_voxels(
  const MapView & map, const Constants & c, const Sight & s, PointSums & sums) {
  F v[line_fields];
  load_fields<0, 4>(map, s, v);
  const F x[3] = {s.p[0] - v[0], s.p[1] - v[1], s.p[2] - v[2]};
  F weight = v[3];
  if (by_radius) {
    const F squared = Lanes::fma(x[0], x[0], Lanes::fma(x[1], x[1], x[2] * x[2]));
    const Lanes::M near = Lanes::less_equal(squared, c.squared_size);
    if (Lanes::bits(near) == 0) {
      return;
    }
    weight = Lanes::only(near, weight);
  }
  load_fields<4, line_fields>(map, s, v);
  const F * const b = v + 4;
  const F f[3] = {
    Lanes::fma(b[0], x[0], Lanes::fma(b[1], x[1], b[2] * x[2])),
    Lanes::fma(b[1], x[0], Lanes::fma(b[3], x[1], b[4] * x[2])),
    Lanes::fma(b[2], x[0], Lanes::fma(b[4], x[1], b[5] * x[2]))};
  const F distance = Lanes::fma(f[0], x[0], Lanes::fma(f[1], x[1], f[2] * x[2]));
  const F e = exp2_negative(c.exponent * distance) * weight;
  sums.score += e;
  sums.nearest = Lanes::max(sums.nearest, e);
  sums.pairs += weight;
  size_t next = 0;
  for (size_t i = 0; i < 3; ++i) {
    const F ef = e * f[i];
    sums.f[i] += ef;
    const F bent = c.minus_d2 * ef;
    for (size_t j = i; j < 3; ++j, ++next) {
      sums.m[next] = Lanes::fma(e, b[next], Lanes::fma(bent, f[j], sums.m[next]));
    }
  }
}

/// M (e_k x q) for k = 0, 1, 2, for one row of M.
inline void turn(const F (&row)[3], const F (&q)[3], F (&out)[3]) {
  out[0] = Lanes::fma(row[2], q[1], -(row[1] * q[2]));
  out[1] = Lanes::fma(row[0], q[2], -(row[2] * q[0]));
  out[2] = Lanes::fma(row[1], q[0], -(row[0] * q[1]));
}

/// Adds the points' sums, multiplied by their factors of q.
inline void add_points(const Sight & s, const PointSums & p, F (&sums)[sum_count]) {
  sums[sum_score] += p.score;
  sums[sum_nearest] += p.nearest;
  sums[sum_pairs] += p.pairs;
  sums[sum_points] += Lanes::min(p.pairs, Lanes::set1(1));
  const F m[3][3] = {{p.m[0], p.m[1], p.m[2]}, {p.m[1], p.m[3], p.m[4]}, {p.m[2], p.m[4], p.m[5]}};
  F mq[3][3];
  for (size_t i = 0; i < 3; ++i) {
    sums[sum_f + i] += p.f[i];
    turn(m[i], s.q, mq[i]);
    for (size_t j = 0; j < 3; ++j) {
      sums[sum_fq + 3 * i + j] = Lanes::fma(p.f[i], s.q[j], sums[sum_fq + 3 * i + j]);
      sums[sum_mq + 3 * i + j] += mq[i][j];
    }
  }
  size_t next = 0;
  for (size_t j = 0; j < 3; ++j) {
    const F column[3] = {mq[0][j], mq[1][j], mq[2][j]};
    F turned[3];
    turn(column, s.q, turned);
    for (size_t i = j; i < 3; ++i, ++next) {
      sums[sum_qmq + next] += turned[i];
    }
  }
  for (size_t i = 0; i < 6; ++i) {
    sums[sum_m + i] += p.m[i];
  }
}

/// Moves the lanes' sums to double precision.
inline void drain(F (&sums)[sum_count], TangentSums & out) {
  for (size_t i = 0; i < sum_count; ++i) {
    out.of[i] += static_cast<double>(Lanes::sum(sums[i]));
    sums[i] = Lanes::set1(0);
  }
}

template<bool by_radius, typename Find>
TangentSums run(
  const MapView & map, const ScanView & scan, const Constants & c, size_t bin, Find find) {
  // Single precision suffices for the terms, but not for sums of very many of them.
  constexpr size_t groups_per_drain = 32;
  F sums[sum_count];
  clear(sums);
  TangentSums out;
  size_t undrained = 0;
  for (size_t number = bin; number < scan.used; number += bin_count) {
    Sight sight = look(map, scan, c, scan.group(number) * group_points, find);
    PointSums points;
    while (sight.cell_count > 0) {
      add_voxels<by_radius>(map, c, sight, points);
      advance(sight);
    }
    add_points(sight, points, sums);
    if (++undrained == groups_per_drain) {
      drain(sums, out);
      undrained = 0;
    }
  }
  drain(sums, out);
  return out;
}

template<typename Find>
TangentSums run_bin(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin,
  Find find) {
  const Constants c = constants_of(*map.header, pose, d2);
  return map.header->search == Search::radius ? run<true>(map, scan, c, bin, find)
                                              : run<false>(map, scan, c, bin, find);
}

TangentSums pass(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin) {
  return run_bin(map, scan, pose, d2, bin, LookUp{});
}

TangentSums derive(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin,
  const uint32_t * found) {
  return run_bin(map, scan, pose, d2, bin, Found{found});
}

void search(
  const MapView & map, const ScanView & scan, const PassPose & pose, size_t bin, uint32_t * found) {
  const Constants c = constants_of(*map.header, pose, 0);
  for (size_t number = bin; number < scan.used; number += bin_count) {
    const size_t first = scan.group(number) * group_points;
    const Sight sight = look(map, scan, c, first, LookUp{});
    std::fill_n(found + first, group_points, empty_list);
    for (size_t i = 0; i < sight.cell_count; ++i) {
      const InCell & in = sight.cells[i];
      for (uint32_t left = Lanes::bits(in.lanes); left != 0; left &= left - 1) {
        found[first + __builtin_ctz(left)] = static_cast<uint32_t>(in.list - map.lists);
      }
    }
  }
}
