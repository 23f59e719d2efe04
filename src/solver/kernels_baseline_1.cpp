// Kernels of one lane, to compare widths.
#if !defined(__wasm__)
#define LENDULET_KERNEL_SPACE baseline_one
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_1;
constexpr SolverKernels baseline_kernels_1 = baseline_one::make_kernels<1>();

}  // namespace lendulet
#endif
