// sin() and cos() to the last bit, in place of emscripten's, which are off by one in a few per cent. glibc's are all
// but always right as well, so rings have the points that they have on x86-64.
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

namespace {

// Of 113 bits, in software: 2 us a call.
static_assert(LDBL_MANT_DIG == 113);

/// The angles of rings are few, and asked for again and again.
template <long double (*function)(long double)>
double remembered(double x) {
  struct Known {
    std::uint64_t key;
    double value;
  };
  static std::array<Known, 512> known;
  if (!std::isfinite(x)) return NAN;
  const auto key = ~std::bit_cast<std::uint64_t>(x);  // not 0
  Known& place = known[key * 0x9E3779B97F4A7C15 >> 55];
  if (place.key != key) place = {key, static_cast<double>(function(x))};
  return place.value;
}

}  // namespace

extern "C" {

double sin(double x) { return remembered<sinl>(x); }
double cos(double x) { return remembered<cosl>(x); }
}
