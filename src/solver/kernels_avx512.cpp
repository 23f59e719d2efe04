// Kernels of width 16 for machines with AVX512; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE avx512
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels avx512_kernels;
constexpr SolverKernels avx512_kernels = avx512::make_kernels<16>();

}  // namespace lendulet
#endif
