#include "world/narrow/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const NarrowKernels baseline_narrow_1, baseline_narrow_4, baseline_narrow_8, baseline_narrow_16;
#if defined(__x86_64__)
extern const NarrowKernels avx2_narrow, avx512_narrow;
#endif

#if defined(__wasm__)
const NarrowKernels& narrow_kernels(int) { return baseline_narrow_4; }
#else
const NarrowKernels& narrow_kernels(int width) {
#if defined(__x86_64__)
    const NarrowKernels *avx2 = &avx2_narrow, *avx512 = &avx512_narrow;
#else
    const NarrowKernels *avx2 = nullptr, *avx512 = nullptr;
#endif
    return table_for_width(width, baseline_narrow_1, baseline_narrow_4, baseline_narrow_8, baseline_narrow_16, avx2,
                           avx512);
}
#endif

}  // namespace lendulet
