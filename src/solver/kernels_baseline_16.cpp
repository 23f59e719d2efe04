// Kernels of width 16 in the instructions every machine has, cut into native vectors by the compiler: to compare widths
// on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE baseline_16
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_16;
constexpr SolverKernels baseline_kernels_16 = baseline_16::make_kernels<16>();

}  // namespace lendulet
