// Functions of <cmath> whose last bits depend on the C library, and in glibc also on the processor: it has others for
// those with fused multiply-adds. These depend on IEEE arithmetic alone, so that surfaces do not
// depend on either. Within three units in the last place of the true value.
#pragma once

namespace vmesh {

/// Of an angle of at most a million, in radians.
double portable_sin(double x);
double portable_cos(double x);
/// In (-pi/2, pi/2).
double portable_atan(double x);
/// Angle of (x, y) with y >= 0, in [0, pi]; 0 of (0, 0).
double portable_angle(double y, double x);
/// Of a positive number; neither it nor the result of portable_expm1() may be subnormal or infinite.
double portable_log(double x);
double portable_log1p(double x);
double portable_expm1(double x);

}  // namespace vmesh
