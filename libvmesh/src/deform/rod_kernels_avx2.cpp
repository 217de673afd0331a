#include "deform/rod_kernels.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)

#pragma GCC target("avx2")

namespace vmesh {
namespace avx2 {
namespace {

#include "deform/rod_kernels_body.h"

}  // namespace
}  // namespace avx2

const RodKernels* avx2_rod_kernels() { return __builtin_cpu_supports("avx2") ? &avx2::kKernels : nullptr; }

}  // namespace vmesh

#else

const vmesh::RodKernels* vmesh::avx2_rod_kernels() { return nullptr; }

#endif
