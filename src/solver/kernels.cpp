#include "solver/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const SolverKernels baseline_kernels_1, baseline_kernels_4, baseline_kernels_8, baseline_kernels_16;
extern const SolverKernels avx2_kernels, avx512_kernels;

namespace {

// clang-format off
constexpr KernelTables<SolverKernels> tables{
#if defined(__wasm__)
    nullptr, &baseline_kernels_4,  // a page loads the module: four lanes will do for one
#else
    &baseline_kernels_1, &baseline_kernels_4,
#endif
#if defined(LENDULET_EMULATED_LANES)
    &baseline_kernels_8, &baseline_kernels_16,
#else
    nullptr, nullptr,
#endif
#if defined(__x86_64__) && !defined(LENDULET_FOUR_LANES)
    &avx2_kernels, &avx512_kernels,
#else
    nullptr, nullptr,
#endif
};
// clang-format on

}  // namespace

int native_width() { return native_lanes(); }

const SolverKernels& solver_kernels(int width) { return tables.of(width); }

}  // namespace lendulet
