// Narrow-phase kernels of width 16 and 8 for machines with AVX512; compiled with that instruction set, see
// src/CMakeLists.txt. Eight lanes gain by its masks and by twice as many registers.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE narrow_avx512
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels avx512_narrow, avx512_narrow_8;
constexpr NarrowKernels avx512_narrow = narrow_avx512::make_narrow_kernels<16>();
constexpr NarrowKernels avx512_narrow_8 = narrow_avx512::make_narrow_kernels<8>();

}  // namespace lendulet
#endif
