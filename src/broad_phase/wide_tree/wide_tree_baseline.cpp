// The inner loops of the wide tree, 4 lanes, in the instructions every machine has.
#define LENDULET_KERNEL_SPACE wide_tree_baseline
#include "broad_phase/wide_tree/wide_tree_kernels.inl"

namespace lendulet {

extern const WideTreeKernels wide_tree_kernels_baseline;
constexpr WideTreeKernels wide_tree_kernels_baseline = wide_tree_baseline::make_wide_tree_kernels<Wide<float, 4>>();

}  // namespace lendulet
