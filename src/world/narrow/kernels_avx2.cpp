// Narrow-phase kernels of width 8 for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE narrow_avx2
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels avx2_narrow;
constexpr NarrowKernels avx2_narrow = narrow_avx2::make_narrow_kernels<8>();

}  // namespace lendulet
#endif
