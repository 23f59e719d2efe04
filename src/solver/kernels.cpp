#include "solver/kernels.h"

#include "math/wide/cpu.h"

namespace lendulet {

extern const SolverKernels baseline_kernels_1, baseline_kernels_4, baseline_kernels_8, baseline_kernels_16;

#if defined(__x86_64__)
extern const SolverKernels avx2_kernels, avx512_kernels;

int native_width() { return cpu_has_avx512() ? 16 : cpu_has_avx2() ? 8 : 4; }

const SolverKernels& solver_kernels(int width) {
    if (width == 16) return cpu_has_avx512() ? avx512_kernels : baseline_kernels_16;
    if (width == 8) return cpu_has_avx2() ? avx2_kernels : baseline_kernels_8;
    return width == 4 ? baseline_kernels_4 : baseline_kernels_1;
}
#elif defined(__wasm__)
// Four lanes are all there are; wider copies would only make the module larger, and give the same bits.
int native_width() { return 4; }
const SolverKernels& solver_kernels(int width) { return width == 1 ? baseline_kernels_1 : baseline_kernels_4; }
#else
int native_width() { return 4; }

const SolverKernels& solver_kernels(int width) {
    return width == 16  ? baseline_kernels_16
           : width == 8 ? baseline_kernels_8
           : width == 4 ? baseline_kernels_4
                        : baseline_kernels_1;
}
#endif

}  // namespace lendulet
