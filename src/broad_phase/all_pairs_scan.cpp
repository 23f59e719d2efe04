// The loop of AllPairs in the instructions every machine has, and the choice of the widest one.
#define LENDULET_KERNEL_SPACE all_pairs_baseline
#include "broad_phase/all_pairs_scan.inl"
#include "math/wide/instruction_sets.h"

namespace lendulet {

#if defined(__x86_64__)
extern const AllPairsScan all_pairs_scan_avx2;
#endif

AllPairsScan all_pairs_scan() {
#if defined(__x86_64__)
    static const bool eight = cpu_has_avx2();
    if (eight) return all_pairs_scan_avx2;
#endif
    return all_pairs_baseline::scan_all_pairs<Wide<float, 4>>;
}

}  // namespace lendulet
