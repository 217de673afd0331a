#pragma once

namespace vmesh {

/// What vmesh_simd_variants() in libvmesh/CMakeLists.txt compiles sources for, each in a namespace of that name. All
/// variants do the same operations in the same order, so their results are the same to the bit.
enum class InstructionSet { plain, avx2 };

/// The fastest one that was compiled and that this machine supports.
InstructionSet best_instruction_set();

/// `name` as compiled for an instruction set; in modules with such sources.
#if VMESH_HAS_AVX2
#define VMESH_VARIANT(set, name) ((set) == InstructionSet::avx2 ? avx2::name : plain::name)
#else
#define VMESH_VARIANT(set, name) (static_cast<void>(set), plain::name)
#endif

}  // namespace vmesh
