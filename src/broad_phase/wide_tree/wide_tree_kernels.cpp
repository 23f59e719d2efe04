#include "broad_phase/wide_tree/wide_tree_kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const WideTreeKernels wide_tree_kernels_baseline;

#if defined(__x86_64__)
extern const WideTreeKernels wide_tree_kernels_avx2, wide_tree_kernels_avx512;

const WideTreeKernels& wide_tree_kernels(int width) {
    if ((width == 0 || width >= 16) && cpu_has_avx512()) return wide_tree_kernels_avx512;
    if ((width == 0 || width >= 8) && cpu_has_avx2()) return wide_tree_kernels_avx2;
    return wide_tree_kernels_baseline;
}
#else
const WideTreeKernels& wide_tree_kernels(int) { return wide_tree_kernels_baseline; }
#endif

}  // namespace lendulet
