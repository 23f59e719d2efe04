// The inner loops of the wide tree, 8 lanes, for machines with AVX2; compiled with that instruction set, see
// src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE wide_tree_avx2
#include "broad_phase/wide_tree/wide_tree_kernels.inl"

namespace lendulet {

extern const WideTreeKernels wide_tree_kernels_avx2;
constexpr WideTreeKernels wide_tree_kernels_avx2 = wide_tree_avx2::make_wide_tree_kernels<Wide<float, 8>>();

}  // namespace lendulet
#endif
