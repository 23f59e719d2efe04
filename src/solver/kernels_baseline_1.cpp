// Kernels of one lane: for what no colour has room for, and to compare widths.
#define LENDULET_KERNEL_SPACE baseline_one
#include "solver/kernels.inl"

namespace lendulet {

extern const SolverKernels baseline_kernels_1;
#if defined(__wasm__)
constexpr SolverKernels baseline_kernels_1 = baseline_one::make_kernels<1, false>();  // see kernels.cpp
#else
constexpr SolverKernels baseline_kernels_1 = baseline_one::make_kernels<1>();
#endif

}  // namespace lendulet
