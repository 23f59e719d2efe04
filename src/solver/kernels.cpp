#include "solver/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const SolverKernels baseline_kernels_1, baseline_kernels_4, baseline_kernels_8, baseline_kernels_16;
extern const SolverKernels avx2_kernels, avx512_kernels;

namespace {

#if defined(__wasm__)
// A page loads the module: there is one copy in it of what any number of lanes will do for.
const SolverKernels one_lane = [] {
    SolverKernels kernels = baseline_kernels_1;
    kernels.take_common(baseline_kernels_4);
    return kernels;
}();
#else
constexpr const SolverKernels& one_lane = baseline_kernels_1;
#endif

// clang-format off
constexpr KernelTables<SolverKernels> tables{
    &one_lane, &baseline_kernels_4,
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
