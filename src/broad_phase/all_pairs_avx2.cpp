// The loop of AllPairs, 8 lanes, for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE all_pairs_avx2
#include "broad_phase/all_pairs_scan.inl"

namespace lendulet {

extern const AllPairsScan all_pairs_scan_avx2;
const AllPairsScan all_pairs_scan_avx2 = all_pairs_avx2::scan_all_pairs<Wide<float, 8>>;

}  // namespace lendulet
#endif
