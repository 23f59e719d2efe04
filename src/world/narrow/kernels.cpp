#include "world/narrow/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const NarrowKernels baseline_narrow_1, baseline_narrow_4, baseline_narrow_8, baseline_narrow_16;
extern const NarrowKernels avx2_narrow, avx512_narrow, avx512_narrow_8;

namespace {

// clang-format off
constexpr KernelTables<NarrowKernels> tables{
#if defined(__wasm__)
    nullptr, &baseline_narrow_4,
#else
    &baseline_narrow_1, &baseline_narrow_4,
#endif
#if defined(LENDULET_EMULATED_LANES)
    &baseline_narrow_8, &baseline_narrow_16,
#else
    nullptr, nullptr,
#endif
#if defined(__x86_64__) && !defined(LENDULET_FOUR_LANES)
    &avx2_narrow, &avx512_narrow, &avx512_narrow_8,
#else
    nullptr, nullptr,
#endif
};
// clang-format on

}  // namespace

const NarrowKernels& narrow_kernels(int width) { return tables.of(width); }

}  // namespace lendulet
