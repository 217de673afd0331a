#include <cmath>

#include "deform/synchronise.h"

namespace vmesh {
namespace plain {
namespace {

#include "deform/synchronise_body.h"

}  // namespace
}  // namespace plain

Synchroniser plain_synchroniser() { return plain::run; }

Synchroniser best_synchroniser() {
  static const Synchroniser best = avx2_synchroniser() ? avx2_synchroniser() : plain_synchroniser();
  return best;
}

}  // namespace vmesh
