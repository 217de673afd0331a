// sin() and cos() to the last bit, in place of emscripten's, which are off by one in a few per cent. glibc's are all
// but always right as well, so rings have the points that they have on x86-64.
#include <cfloat>
#include <cmath>

// Numbers of 113 bits, in software: 2 us a call, of which there are a few for each vertex.
static_assert(LDBL_MANT_DIG == 113);

extern "C" {

double sin(double x) { return static_cast<double>(sinl(x)); }
double cos(double x) { return static_cast<double>(cosl(x)); }
}
