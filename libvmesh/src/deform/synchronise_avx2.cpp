#include <cmath>

#include "deform/synchronise.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)

#pragma GCC target("avx2")

namespace vmesh {
namespace avx2 {
namespace {

#include "deform/synchronise_body.h"

}  // namespace
}  // namespace avx2

Synchroniser avx2_synchroniser() { return __builtin_cpu_supports("avx2") ? avx2::run : nullptr; }

}  // namespace vmesh

#else

vmesh::Synchroniser vmesh::avx2_synchroniser() { return nullptr; }

#endif
