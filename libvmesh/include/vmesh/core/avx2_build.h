#pragma once

/// Whether this build has AVX2 kernels beside the plain ones: compiling single functions for another instruction set
/// needs GCC on x86-64, and gains nothing without optimisation.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)
#define VMESH_AVX2_BUILD 1
#else
#define VMESH_AVX2_BUILD 0
#endif

namespace vmesh {

/// Whether this machine supports them.
inline bool has_avx2() {
#if VMESH_AVX2_BUILD
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace vmesh
