// Kernels of width 8 in the instructions every machine has, cut into native vectors by the compiler: to compare widths
// on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE baseline_8
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_8;
constexpr SolverKernels baseline_kernels_8 = baseline_8::make_kernels<8>();

}  // namespace lendulet
