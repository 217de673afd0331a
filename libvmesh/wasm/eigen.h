// Eigen with packets of SSE2, which emscripten makes those of WebAssembly; included before everything. So sums are in
// the order that they have on x86-64, (x + y) + z and not x + (y + z).
#pragma once
#if defined(__cplusplus) && __cplusplus >= 202002L && !defined(EIGEN_CORE_H)

#include <cmath>
#include <complex>
#include <cstring>
#include <functional>
#include <limits>
#include <sstream>

// Eigen's assembly works around faults of old compilers; it has none for a GCC of this version.
#pragma push_macro("__GNUC__")
#undef __GNUC__
#define __GNUC__ 12
// What is left of it are empty statements.
#define __asm__(...)
#include <Eigen/Core>
#undef __asm__
#pragma pop_macro("__GNUC__")
// CGAL would take it for an Intel.
#undef __SSE__
#undef __SSE2__

#ifndef EIGEN_VECTORIZE_SSE2
#error "Eigen does not use SSE2: sums would be in another order than in other builds"
#endif

#endif
