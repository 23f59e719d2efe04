// Narrow-phase kernels of width 16 for machines with AVX512; compiled with that instruction set, see
// src/CMakeLists.txt.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE narrow_avx512
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels avx512_narrow;
constexpr NarrowKernels avx512_narrow = narrow_avx512::make_narrow_kernels<16>();

}  // namespace lendulet
#endif
