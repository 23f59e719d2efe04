// The loops of AllPairs in the instructions every machine has, and the choice of the widest ones.
#define LENDULET_KERNEL_SPACE all_pairs_baseline
#include "broad_phase/all_pairs_scan.inl"
#include "math/wide/instruction_sets.h"

namespace lendulet {

namespace {

constexpr AllPairsKernels baseline = all_pairs_baseline::make_all_pairs_kernels<Wide<float, 4>>();

}  // namespace

#if defined(__x86_64__)
extern const AllPairsKernels all_pairs_kernels_avx2;
#endif

const AllPairsKernels& all_pairs_kernels() {
#if defined(__x86_64__)
    if (cpu_has_avx2()) return all_pairs_kernels_avx2;
#endif
    return baseline;
}

}  // namespace lendulet
