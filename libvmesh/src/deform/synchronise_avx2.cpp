#include <cmath>

#include "vmesh/core/avx2_build.h"

#include "deform/synchronise.h"

#if VMESH_AVX2_BUILD

#pragma GCC target("avx2")

namespace vmesh {
namespace avx2 {
namespace {

#include "deform/synchronise_body.h"

}  // namespace
}  // namespace avx2

Synchroniser avx2_synchroniser() { return has_avx2() ? avx2::run : nullptr; }

}  // namespace vmesh

#else

vmesh::Synchroniser vmesh::avx2_synchroniser() { return nullptr; }

#endif
