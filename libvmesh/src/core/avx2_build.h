#pragma once

/// Whether this build has kernels for AVX2 beside the plain ones: one function in another set of instructions than its
/// neighbours takes GCC on x86-64, and gains nothing without optimisation.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)
#define VMESH_AVX2_BUILD 1
#else
#define VMESH_AVX2_BUILD 0
#endif

namespace vmesh {

/// Whether they can be used here.
inline bool has_avx2() {
#if VMESH_AVX2_BUILD
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace vmesh
