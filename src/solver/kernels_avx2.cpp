// Kernels of width 8 for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE avx2
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels avx2_kernels;
constexpr SolverKernels avx2_kernels = avx2::make_kernels<8>();

}  // namespace lendulet
#endif
