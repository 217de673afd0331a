#include "vmesh/core/avx2_build.h"

#include "deform/rod_kernels.h"

#if VMESH_AVX2_BUILD

#pragma GCC target("avx2")

namespace vmesh {
namespace avx2 {
namespace {

#include "deform/rod_kernels_body.h"

}  // namespace
}  // namespace avx2

const RodKernels* avx2_rod_kernels() { return has_avx2() ? &avx2::kKernels : nullptr; }

}  // namespace vmesh

#else

const vmesh::RodKernels* vmesh::avx2_rod_kernels() { return nullptr; }

#endif
