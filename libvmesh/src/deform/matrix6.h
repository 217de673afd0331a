#pragma once

#include <algorithm>
#include <array>

#include "deform/spatial.h"

namespace vmesh {

/// Two numbers that are worked on at once, where the machine can: an extension that GCC and Clang share.
using Pair = double __attribute__((vector_size(16)));

/// Number i of `a` and number k of `b`.
template <int i, int k>
[[gnu::always_inline]] inline Pair pick(Pair a, Pair b) {
  return __builtin_shufflevector(a, b, i, 2 + k);
}

/// A Spatial in one piece, linear before angular. Where time counts, numbers stay in pairs and do not go through
/// memory one by one: a pair would wait for its halves.
struct Vector6 {
  std::array<Pair, 3> pairs;

  Vector6() = default;
  Vector6(const Vec3& linear, const Vec3& angular)
      : pairs{Pair{linear[0], linear[1]}, Pair{linear[2], angular[0]}, Pair{angular[1], angular[2]}} {}
  explicit Vector6(const Spatial& x) : Vector6(x.linear, x.angular) {}

  double operator[](int i) const { return pairs[static_cast<std::size_t>(i / 2)][i % 2]; }
  void set(int i, double value) { pairs[static_cast<std::size_t>(i / 2)][i % 2] = value; }
  Vec3 linear() const { return {(*this)[0], (*this)[1], (*this)[2]}; }
  Vec3 angular() const { return {(*this)[3], (*this)[4], (*this)[5]}; }
  [[gnu::always_inline]] Vector6& operator+=(const Vector6& v) {
    for (std::size_t p = 0; p < 3; ++p) pairs[p] += v.pairs[p];
    return *this;
  }
};

inline Vector6 operator+(Vector6 a, const Vector6& b) { return a += b; }

/// To `to`, factor times v, from the pair that holds entry `from` on.
[[gnu::always_inline]] inline void add(Vector6& to, double factor, const Vector6& v, int from = 0) {
  for (std::size_t p = static_cast<std::size_t>(from / 2); p < 3; ++p) to.pairs[p] += factor * v.pairs[p];
}
[[gnu::always_inline]] inline Vector6 scaled(double factor, Vector6 v) {
  for (Pair& p : v.pairs) p *= factor;
  return v;
}

/// A symmetric 6x6 matrix.
struct Matrix6 {
  std::array<Vector6, 6> columns;

  Vector6& operator[](int i) { return columns[static_cast<std::size_t>(i)]; }
  const Vector6& operator[](int i) const { return columns[static_cast<std::size_t>(i)]; }
  [[gnu::always_inline]] Matrix6& operator+=(const Matrix6& m) {
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) (*this)[i] += m[i];
    return *this;
  }
  /// From its entries on and below the diagonal.
  [[gnu::always_inline]] void mirror() {
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 6; i += 2) {
      columns[i + 1].pairs[i / 2] = pick<1, 1>(columns[i].pairs[i / 2], columns[i + 1].pairs[i / 2]);
#pragma GCC unroll 2
      for (std::size_t p = 0; p < i / 2; ++p) {
        const Pair even = columns[2 * p].pairs[i / 2], odd = columns[2 * p + 1].pairs[i / 2];
        columns[i].pairs[p] = pick<0, 0>(even, odd);
        columns[i + 1].pairs[p] = pick<1, 1>(even, odd);
      }
    }
  }
  Mat3 angular() const {
    Mat3 m;
    for (int i = 0; i < 3; ++i) m.col(i) = (*this)[3 + i].angular();
    return m;
  }
};

/// A copy number by number: as a whole it would be made by an instruction that is slow to start.
[[gnu::always_inline]] inline void copy(const Matrix6& from, Matrix6& to) {
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) to[i] = from[i];
}

/// (linear, angular + lever x linear).
class Carried {
 public:
  [[gnu::always_inline]] explicit Carried(const Vec3& lever)
      : zx_{lever[2], lever[0]}, xy_{lever[0], lever[1]}, y_{0, lever[1]}, z_{0, lever[2]} {}

  [[gnu::always_inline]] Vector6 operator()(Vector6 v) const {
    const auto [first, middle, last] = v.pairs;
    v.pairs[1] += y_ * pick<0, 0>(middle, middle) - z_ * pick<1, 1>(first, first);
    v.pairs[2] += zx_ * first - xy_ * pick<0, 0>(middle, first);
    return v;
  }

 private:
  Pair zx_, xy_, y_, z_;
};

/// The symmetric matrix whose product does the same on both sides.
[[gnu::always_inline]] inline void carry(const Vec3& lever, Matrix6& m) {
  add(m[3], lever[1], m[2]), add(m[3], -lever[2], m[1]);
  add(m[4], lever[2], m[0]), add(m[4], -lever[0], m[2]);
  add(m[5], lever[0], m[1]), add(m[5], -lever[1], m[0]);
  const auto& [x, y, z] = std::array{m[3].pairs, m[4].pairs, m[5].pairs};
  m[0].pairs = {m[0].pairs[0], pick<0, 0>(m[0].pairs[1], x[0]), pick<0, 0>(y[0], z[0])};
  m[1].pairs = {m[1].pairs[0], pick<0, 1>(m[1].pairs[1], x[0]), pick<1, 1>(y[0], z[0])};
  m[2].pairs = {m[2].pairs[0], pick<0, 0>(m[2].pairs[1], x[1]), pick<0, 0>(y[1], z[1])};
  const Carried carried(lever);
  for (int i = 3; i < 6; ++i) m[i] = carried(m[i]);
}

/// L D L^T of a symmetric positive definite matrix, of which only what is on and below the diagonal is read.
class Factors6 {
 public:
  /// A pivot that rounding made too small or negative is raised, so that the inverse becomes smaller: safe for
  /// stiffness.
  [[gnu::always_inline]] explicit Factors6(const Matrix6& m) {
    copy(m, lower_);
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) {
      inverse_[static_cast<std::size_t>(k)] = 1 / std::max(lower_[k][k], kRounding * m[k][k]);
      const Vector6 column = scaled(inverse_[static_cast<std::size_t>(k)], lower_[k]);
#pragma GCC unroll 6
      for (int j = k + 1; j < 6; ++j) add(lower_[j], -column[j], lower_[k], j);
      lower_[k] = column;
    }
  }

  Vector6 solve(Vector6 v) const {
    for (int k = 0; k < 6; ++k)
      for (int i = k + 1; i < 6; ++i) v.set(i, v[i] - lower_[k][i] * v[k]);
    for (int k = 6; k-- > 0;) {
      v.set(k, v[k] * inverse_[static_cast<std::size_t>(k)]);
      for (int i = k + 1; i < 6; ++i) v.set(k, v[k] - lower_[k][i] * v[i]);
    }
    return v;
  }

  /// To r and g, -b m^-1 b and -b m^-1 f, for a symmetric b.
  [[gnu::always_inline]] void subtract_series(const Matrix6& b, Vector6 f, Matrix6& r, Vector6& g) const {
    Matrix6 rows;  // of L^-1 b; not symmetric
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
      rows[i] = b[i];
#pragma GCC unroll 6
      for (int k = 0; k < i; ++k) add(rows[i], -lower_[k][i], rows[k]);
    }
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) {
      const Vector6 row = scaled(-inverse_[static_cast<std::size_t>(k)], rows[k]);
#pragma GCC unroll 6
      for (int i = 0; i < 6; ++i) add(r[i], row[i], rows[k], i);
      add(g, f[k], row);
      add(f, -f[k], lower_[k], k);
    }
    r.mirror();
  }

 private:
  Matrix6 lower_;  ///< L below the diagonal, what is left of the work above
  std::array<double, 6> inverse_;
};

}  // namespace vmesh
