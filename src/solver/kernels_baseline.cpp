// Kernels in the instructions every machine has, four lanes.
#define LENDULET_KERNEL_SPACE baseline
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_4;
constexpr SolverKernels baseline_kernels_4 = baseline::make_kernels<4>();

}  // namespace lendulet
