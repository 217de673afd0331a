// After fdlibm, with its polynomials:
//   Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunPro, a Sun Microsystems, Inc.
//   business. Permission to use, copy, modify, and distribute this software is freely granted, provided that this
//   notice is preserved.
#include "vmesh/core/portable_math.h"

#include <cmath>
#include <numbers>

namespace vmesh {
namespace {

/// x - n pi/2 as the sum of two numbers, |head| <= pi/4.
struct Quarter {
  int n = 0;  ///< modulo 4
  double head = 0, tail = 0;
};

Quarter quarter_of(double x) {
  constexpr double kFirst = 1.57079632673412561417e+00;  // 33 bits of pi/2
  constexpr double kSecond = 6.07710050630396597660e-11, kSecondTail = 2.02226624879595063154e-21;
  const double n = std::rint(x * 6.36619772367581382433e-01);
  const double first = x - n * kFirst;
  const double second = n * kSecond;
  const double rest = first - second;
  const double tail = n * kSecondTail - ((first - rest) - second);
  const double head = rest - tail;
  return {static_cast<int>(static_cast<long long>(n) & 3), head, (rest - head) - tail};
}

double sin_of(double x, double tail) {
  const double z = x * x, w = z * z;
  const double r = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                   z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const double v = z * x;
  return x - ((z * (0.5 * tail - v * r) - tail) - v * -1.66666666666666324348e-01);
}

double cos_of(double x, double tail) {
  const double z = x * x, w = z * z;
  const double r =
      z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
      w * w * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
  const double half = 0.5 * z, most = 1 - half;
  return most + (((1 - most) - half) + (z * r - x * tail));
}

/// atan(x) - x of |x| <= 7/16, negated.
double lack_of_atan(double x) {
  constexpr double kA[] = {3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
                           -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
                           6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
                           -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  const double z = x * x, w = z * z;
  const double even = z * (kA[0] + w * (kA[2] + w * (kA[4] + w * (kA[6] + w * (kA[8] + w * kA[10])))));
  const double odd = w * (kA[1] + w * (kA[3] + w * (kA[5] + w * (kA[7] + w * kA[9]))));
  return x * (even + odd);
}

constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

double exp_of(double x) {
  const double k = std::rint(x * std::numbers::log2e);
  const double high = x - k * kLn2High, low = k * kLn2Low;
  const double r = high - low, z = r * r;
  const double c =
      r -
      z * (1.66666666666666019037e-01 +
           z * (-2.77777777770155933842e-03 +
                z * (6.61375632143793436117e-05 + z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
  return std::ldexp(1 + (r * c / (2 - c) - low + high), static_cast<int>(k));
}

}  // namespace

double portable_sin(double x) {
  const Quarter at = quarter_of(x);
  const double value = at.n % 2 == 0 ? sin_of(at.head, at.tail) : cos_of(at.head, at.tail);
  return at.n < 2 ? value : -value;
}

double portable_cos(double x) {
  const Quarter at = quarter_of(x);
  const double value = at.n % 2 == 0 ? cos_of(at.head, at.tail) : sin_of(at.head, at.tail);
  return at.n == 0 || at.n == 3 ? value : -value;
}

double portable_atan(double x) {
  // Around the nearest of these: of 1/2, 1, 3/2 and infinity, each with what rounding took.
  const double a = std::abs(x);
  if (!(a >= 0.4375)) return x - lack_of_atan(x);
  double reduced = -1 / a, high = 1.57079632679489655800e+00, low = 6.12323399573676603587e-17;
  if (a < 0.6875) {
    reduced = (2 * a - 1) / (2 + a), high = 4.63647609000806093515e-01, low = 2.26987774529616870924e-17;
  } else if (a < 1.1875) {
    reduced = (a - 1) / (a + 1), high = 7.85398163397448278999e-01, low = 3.06161699786838301793e-17;
  } else if (a < 2.4375) {
    reduced = (a - 1.5) / (1 + 1.5 * a), high = 9.82793723247329054082e-01, low = 1.39033110312309984516e-17;
  }
  return std::copysign(high - ((lack_of_atan(reduced) - low) - reduced), x);
}

double portable_angle(double y, double x) {
  if (y == 0) return x < 0 ? std::numbers::pi : 0;
  if (x == 0) return std::numbers::pi / 2;
  return x > 0 ? portable_atan(y / x) : std::numbers::pi - portable_atan(y / -x);
}

double portable_log(double x) {
  int k = 0;
  double m = std::frexp(x, &k);
  if (m < std::numbers::sqrt2 / 2) m *= 2, --k;
  const double f = m - 1, s = f / (2 + f), z = s * s, w = z * z;
  const double even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half = 0.5 * f * f;
  return s * (half + (even + odd)) + k * kLn2Low - half + f + k * kLn2High;
}

// Kahan's: the errors of the two factors cancel.
double portable_log1p(double x) {
  const double sum = 1 + x;
  return sum == 1 ? x : portable_log(sum) * x / (sum - 1);
}

double portable_expm1(double x) {
  const double power = exp_of(x);
  if (power == 1) return x;
  const double less = power - 1;
  return less == -1 ? -1 : less * x / portable_log(power);
}

}  // namespace vmesh
