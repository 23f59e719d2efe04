// The inner loops of the wide tree, 16 lanes, for machines with AVX-512; compiled with that instruction set, see
// src/CMakeLists.txt.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE wide_tree_avx512
#include "broad_phase/wide_tree/wide_tree_kernels.inl"

namespace lendulet {

extern const WideTreeKernels wide_tree_kernels_avx512;
constexpr WideTreeKernels wide_tree_kernels_avx512 = wide_tree_avx512::make_wide_tree_kernels<Wide<float, 16>>();

}  // namespace lendulet
#endif
