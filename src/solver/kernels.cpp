#include "solver/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const SolverKernels baseline_kernels_1, baseline_kernels_4, baseline_kernels_8, baseline_kernels_16;
#if defined(__x86_64__)
extern const SolverKernels avx2_kernels, avx512_kernels;
#endif

int native_width() { return native_lanes(); }

#if defined(__wasm__)
// Four lanes are all there are; wider copies would only make the module larger, and give the same bits.
const SolverKernels& solver_kernels(int width) { return width == 1 ? baseline_kernels_1 : baseline_kernels_4; }
#else
const SolverKernels& solver_kernels(int width) {
#if defined(__x86_64__)
    const SolverKernels *avx2 = &avx2_kernels, *avx512 = &avx512_kernels;
#else
    const SolverKernels *avx2 = nullptr, *avx512 = nullptr;
#endif
    return table_for_width(width, baseline_kernels_1, baseline_kernels_4, baseline_kernels_8, baseline_kernels_16, avx2,
                           avx512);
}
#endif

}  // namespace lendulet
