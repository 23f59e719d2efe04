// Kernels in the instructions every machine has, one lane and four.
#define LENDULET_KERNEL_SPACE baseline
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_1, baseline_kernels_4;
constexpr SolverKernels baseline_kernels_1 = baseline::make_kernels<1>();
constexpr SolverKernels baseline_kernels_4 = baseline::make_kernels<4>();

}  // namespace lendulet
