// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace manycore::ndt {

template<size_t N>
using Vector = std::array<double, N>;
template<size_t N>
using Matrix = std::array<std::array<double, N>, N>;

using Vector3 = Vector<3>;
using Matrix3 = Matrix<3>;
using Vector6 = Vector<6>;
using Matrix6 = Matrix<6>;

template<size_t N>
double dot(const Vector<N> & a, const Vector<N> & b) {
  double sum = 0;
  for (size_t i = 0; i < N; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

template<size_t N>
double norm(const Vector<N> & a) {
  return std::sqrt(dot(a, a));
}

template<size_t N>
Vector<N> operator*(const Matrix<N> & a, const Vector<N> & b) {
  Vector<N> product{};
  for (size_t i = 0; i < N; ++i) {
    product[i] = dot(a[i], b);
  }
  return product;
}

template<size_t N>
bool is_finite(const Vector<N> & a) {
  for (const double x : a) {
    if (!std::isfinite(x)) {
      return false;
    }
  }
  return true;
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as columns.
template<size_t N>
struct Eigen {
  Vector<N> values{};
  Matrix<N> vectors{};

  /// Matrix with the same eigenvectors and f(eigenvalue) for each eigenvalue.
  template<typename F>
  Matrix<N> map(F && f) const {
    Matrix<N> out{};
    for (size_t k = 0; k < N; ++k) {
      const double value = f(values[k]);
      for (size_t i = 0; i < N; ++i) {
        for (size_t j = 0; j < N; ++j) {
          out[i][j] += value * vectors[i][k] * vectors[j][k];
        }
      }
    }
    return out;
  }
};

/// Jacobi's method: slow for large matrices, but exact and simple for 3 x 3 and 6 x 6.
template<size_t N>
Eigen<N> symmetric_eigen(Matrix<N> a) {
  constexpr int sweeps = 30;  // convergence is quadratic: about 6 are needed
  Eigen<N> out;
  for (size_t i = 0; i < N; ++i) {
    out.vectors[i][i] = 1;
  }
  const auto rotate = [&](size_t p, size_t q) {
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1);
    const double s = t * c;
    for (size_t k = 0; k < N; ++k) {
      const double kp = a[k][p];
      const double kq = a[k][q];
      a[k][p] = c * kp - s * kq;
      a[k][q] = s * kp + c * kq;
    }
    for (size_t k = 0; k < N; ++k) {
      const double pk = a[p][k];
      const double qk = a[q][k];
      a[p][k] = c * pk - s * qk;
      a[q][k] = s * pk + c * qk;
      const double vp = out.vectors[k][p];
      const double vq = out.vectors[k][q];
      out.vectors[k][p] = c * vp - s * vq;
      out.vectors[k][q] = s * vp + c * vq;
    }
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool diagonal = true;
    for (size_t p = 0; p < N; ++p) {
      for (size_t q = p + 1; q < N; ++q) {
        if (std::abs(a[p][q]) > 1e-17 * std::sqrt(std::abs(a[p][p] * a[q][q])) && a[p][q] != 0) {
          rotate(p, q);
          diagonal = false;
        }
      }
    }
    if (diagonal) {
      break;
    }
  }
  for (size_t i = 0; i < N; ++i) {
    out.values[i] = a[i][i];
  }
  return out;
}

}  // namespace manycore::ndt
