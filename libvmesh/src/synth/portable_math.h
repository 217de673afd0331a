#pragma once

#include <cmath>
#include <cstdint>

#include "vmesh/core/types.h"

// Numbers that are the same on every platform: the standard library's distributions and elementary functions differ in
// their last bits between implementations, and a single bit leads to a different tree. Only operations that IEEE 754
// defines exactly are used here (+ - * / sqrt, frexp and ldexp).
namespace vmesh::portable {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53); }
  /// In the cube [-1, 1)^3.
  Vec3 in_cube() {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

inline double dot(const Vec3& a, const Vec3& b) { return a.x() * b.x() + a.y() * b.y() + a.z() * b.z(); }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// `fallback` when `a` has no direction.
inline Vec3 unit(const Vec3& a, const Vec3& fallback) {
  const double n = norm(a);
  if (!(n > 1e-12)) return fallback;
  return a / n;
}
/// A unit vector perpendicular to the unit vector `a`.
inline Vec3 any_perpendicular(const Vec3& a) {
  const Vec3 other = std::abs(a.x()) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return unit(other - dot(a, other) * a, Vec3(0, 0, 1));
}

inline constexpr double kLn2 = 0x1.62e42fefa39efp-1;

/// Natural logarithm of x > 0.
inline double log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  const double s = (m - 1) / (m + 1);
  double sum = 0;
  for (int k = 25; k >= 1; k -= 2) sum = sum * s * s + 1.0 / k;
  return 2 * s * sum + exponent * kLn2;
}

inline double exp(double x) {
  const double k = std::floor(x / kLn2 + 0.5);
  const double r = x - k * kLn2;
  double sum = 1;
  for (int i = 18; i >= 1; --i) sum = 1 + sum * r / i;
  return std::ldexp(sum, static_cast<int>(k));
}

/// x^y for x > 0.
inline double pow(double x, double y) { return exp(y * log(x)); }

/// Cube root of x > 0.
inline double cbrt(double x) {
  double y = exp(log(x) / 3);
  for (int i = 0; i < 2; ++i) y -= (y - x / (y * y)) / 3;
  return y;
}

/// Sine and cosine of |x| <= 4.
inline double sin(double x) {
  double sum = 1;
  for (int k = 30; k >= 2; k -= 2) sum = 1 - sum * x * x / (k * (k + 1));
  return x * sum;
}
inline double cos(double x) {
  double sum = 1;
  for (int k = 29; k >= 1; k -= 2) sum = 1 - sum * x * x / (k * (k + 1));
  return sum;
}

}  // namespace vmesh::portable
