// The loops of AllPairs, 8 lanes, for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE all_pairs_avx2
#include "broad_phase/all_pairs_scan.inl"

namespace lendulet {

extern const AllPairsKernels all_pairs_kernels_avx2;
const AllPairsKernels all_pairs_kernels_avx2 = all_pairs_avx2::make_all_pairs_kernels<Wide<float, 8>>();

}  // namespace lendulet
#endif
