#include "deform/rod_kernels.h"

namespace vmesh {
namespace plain {
namespace {

#include "deform/rod_kernels_body.h"

}  // namespace
}  // namespace plain

const RodKernels* plain_rod_kernels() { return &plain::kKernels; }

const RodKernels& best_rod_kernels() {
  static const RodKernels& best = avx2_rod_kernels() ? *avx2_rod_kernels() : *plain_rod_kernels();
  return best;
}

}  // namespace vmesh
