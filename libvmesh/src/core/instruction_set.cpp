#include "vmesh/core/instruction_set.h"

namespace vmesh {

InstructionSet best_instruction_set() {
#if VMESH_HAS_AVX2
  if (__builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::plain;
}

}  // namespace vmesh
