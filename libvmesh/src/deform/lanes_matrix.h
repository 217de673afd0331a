// Symmetric 6x6 matrices, four at a time, like lanes.h.
#pragma once

#include "deform/lanes.h"

namespace vmesh::VMESH_INSTRUCTION_SET {
namespace {

VMESH_INLINE constexpr std::size_t at(std::size_t i, std::size_t j) {
  return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
}

struct LanesVector {
  Lanes entries[6];

  VMESH_INLINE explicit LanesVector(const LanesSpatial& s)
      : entries{s.linear.x, s.linear.y, s.linear.z, s.angular.x, s.angular.y, s.angular.z} {}
  VMESH_INLINE Lanes& operator[](std::size_t i) { return entries[i]; }
  VMESH_INLINE const Lanes& operator[](std::size_t i) const { return entries[i]; }
  VMESH_INLINE LanesSpatial spatial() const {
    return {{entries[0], entries[1], entries[2]}, {entries[3], entries[4], entries[5]}};
  }
};

VMESH_INLINE LanesSpatial operator+(const LanesSpatial& a, const LanesSpatial& b) {
  return {a.linear + b.linear, a.angular + b.angular};
}

/// Row i, and column j, of the block of angular rows and linear columns.
VMESH_INLINE Lanes3 mixed_row(const LanesMatrix& m, std::size_t i) {
  return {m.entries[at(3 + i, 0)], m.entries[at(3 + i, 1)], m.entries[at(3 + i, 2)]};
}
VMESH_INLINE Lanes3 mixed_column(const LanesMatrix& m, std::size_t j) {
  return {m.entries[at(3, j)], m.entries[at(4, j)], m.entries[at(5, j)]};
}
VMESH_INLINE void set_mixed_column(LanesMatrix& m, std::size_t j, const Lanes3& v) {
  m.entries[at(3, j)] = v.x, m.entries[at(4, j)] = v.y, m.entries[at(5, j)] = v.z;
}

/// Adds stiffness: `linear` against translation, `axial` against rotation about z, `transverse` about the other axes.
VMESH_INLINE void add_diagonal(LanesMatrix& m, Lanes linear, Lanes transverse, Lanes axial, const Lanes3& z) {
  for (std::size_t i = 0; i < 3; ++i) m.entries[at(i, i)] += linear;
  const Lanes3 excess = (axial - transverse) * z;
  m.entries[at(3, 3)] += transverse + excess.x * z.x;
  m.entries[at(4, 3)] += excess.x * z.y;
  m.entries[at(4, 4)] += transverse + excess.y * z.y;
  m.entries[at(5, 3)] += excess.x * z.z;
  m.entries[at(5, 4)] += excess.y * z.z;
  m.entries[at(5, 5)] += transverse + excess.z * z.z;
}

/// Copies entry by entry: a whole assignment would be compiled to an instruction with a long start-up.
VMESH_INLINE void copy(const LanesMatrix& from, LanesMatrix& to) {
#pragma GCC unroll 21
  for (std::size_t k = 0; k < 21; ++k) to.entries[k] = from.entries[k];
}
VMESH_INLINE void clear(LanesMatrix& m) {
#pragma GCC unroll 21
  for (std::size_t k = 0; k < 21; ++k) m.entries[k] = all(0);
}

/// (linear, angular + lever x linear), and the corresponding congruence transformation of a matrix.
VMESH_INLINE LanesSpatial carried(const Lanes3& lever, const LanesSpatial& v) {
  return {v.linear, v.angular + cross(lever, v.linear)};
}
VMESH_INLINE void carry(const Lanes3& lever, LanesMatrix& m) {
  const Lanes3 old_x = mixed_row(m, 0), old_y = mixed_row(m, 1), old_z = mixed_row(m, 2);
#pragma GCC unroll 3
  for (std::size_t j = 0; j < 3; ++j) {
    const Lanes3 column{m.entries[at(0, j)], m.entries[at(1, j)], m.entries[at(2, j)]};
    set_mixed_column(m, j, mixed_column(m, j) + cross(lever, column));
  }
  const Lanes3 x = cross(lever, mixed_row(m, 0)), y = cross(lever, mixed_row(m, 1)), z = cross(lever, mixed_row(m, 2));
  const Lanes3 u = cross(lever, old_x), v = cross(lever, old_y), w = cross(lever, old_z);
  m.entries[at(3, 3)] += u.x + x.x;
  m.entries[at(4, 3)] += u.y + y.x;
  m.entries[at(5, 3)] += u.z + z.x;
  m.entries[at(4, 4)] += v.y + y.y;
  m.entries[at(5, 4)] += v.z + z.y;
  m.entries[at(5, 5)] += w.z + z.z;
}

/// Where a difference that must be positive is lost to rounding, it is replaced by this times the minuend.
constexpr double kLeastPivot = 1e-15;

/// L D L^T of symmetric positive definite matrices. A pivot that rounding made too small or negative is raised, which
/// makes the inverse smaller: the safe side for a stiffness.
struct LanesFactors {
  LanesMatrix lower;  ///< L below the diagonal
  Lanes inverse[6];

  VMESH_INLINE explicit LanesFactors(const LanesMatrix& m) {
    copy(m, lower);
#pragma GCC unroll 6
    for (std::size_t k = 0; k < 6; ++k) {
      inverse[k] = 1 / larger(lower.entries[at(k, k)], kLeastPivot * m.entries[at(k, k)]);
      Lanes scaled[6];
#pragma GCC unroll 6
      for (std::size_t i = k + 1; i < 6; ++i) scaled[i] = inverse[k] * lower.entries[at(i, k)];
#pragma GCC unroll 6
      for (std::size_t j = k + 1; j < 6; ++j)
#pragma GCC unroll 6
        for (std::size_t i = j; i < 6; ++i) lower.entries[at(i, j)] -= scaled[j] * lower.entries[at(i, k)];
#pragma GCC unroll 6
      for (std::size_t i = k + 1; i < 6; ++i) lower.entries[at(i, k)] = scaled[i];
    }
  }

  VMESH_INLINE LanesVector solve(LanesVector v) const {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < 6; ++k)
#pragma GCC unroll 6
      for (std::size_t i = k + 1; i < 6; ++i) v[i] -= lower.entries[at(i, k)] * v[k];
#pragma GCC unroll 6
    for (std::size_t k = 6; k-- > 0;) {
      v[k] *= inverse[k];
#pragma GCC unroll 6
      for (std::size_t i = k + 1; i < 6; ++i) v[k] -= lower.entries[at(i, k)] * v[i];
    }
    return v;
  }

  /// Adds -b m^-1 b to r and -b m^-1 f to g, for a symmetric b.
  VMESH_INLINE void subtract_series(const LanesMatrix& b, LanesVector f, LanesMatrix& r, LanesVector& g) const {
    Lanes rows[6][6];  // of L^-1 b
#pragma GCC unroll 6
    for (std::size_t i = 0; i < 6; ++i) {
#pragma GCC unroll 6
      for (std::size_t j = 0; j < 6; ++j) rows[i][j] = b.entries[at(i, j)];
#pragma GCC unroll 6
      for (std::size_t k = 0; k < i; ++k) {
        f[i] -= lower.entries[at(i, k)] * f[k];
#pragma GCC unroll 6
        for (std::size_t j = 0; j < 6; ++j) rows[i][j] -= lower.entries[at(i, k)] * rows[k][j];
      }
#pragma GCC unroll 6
      for (std::size_t j = 0; j < 6; ++j) {
        const Lanes factor = inverse[i] * rows[i][j];
        g[j] -= factor * f[i];
#pragma GCC unroll 6
        for (std::size_t k = 0; k <= j; ++k) r.entries[at(j, k)] -= factor * rows[i][k];
      }
    }
  }
};

/// Inverses of the angular blocks, with pivots as above.
VMESH_INLINE Lanes33 inverse_angular(const LanesMatrix& m) {
  const Lanes a00 = m.entries[at(3, 3)], a01 = m.entries[at(4, 3)], a02 = m.entries[at(5, 3)];
  const Lanes a11 = m.entries[at(4, 4)], a12 = m.entries[at(5, 4)], a22 = m.entries[at(5, 5)];
  const Lanes i0 = 1 / a00, l10 = a01 * i0, l20 = a02 * i0;
  const Lanes i1 = 1 / larger(a11 - l10 * a01, kLeastPivot * a11);
  const Lanes u12 = a12 - l10 * a02, l21 = u12 * i1;
  const Lanes i2 = 1 / larger(a22 - l20 * a02 - l21 * u12, kLeastPivot * a22);
  const Lanes m20 = l10 * l21 - l20;  // the last row of L^-1 is (m20, -l21, 1)
  const Lanes r01 = -l10 * i1 - l21 * m20 * i2, r02 = m20 * i2, r12 = -l21 * i2;
  return {{i0 + l10 * l10 * i1 + m20 * m20 * i2, r01, r02}, {r01, i1 + l21 * l21 * i2, r12}, {r02, r12, i2}};
}

}  // namespace
}  // namespace vmesh::VMESH_INSTRUCTION_SET
