#include "world/body_lanes/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const BodyKernels baseline_bodies_1, baseline_bodies_4, baseline_bodies_8, baseline_bodies_16;
extern const BodyKernels avx2_bodies, avx512_bodies;

namespace {

// clang-format off
constexpr KernelTables<BodyKernels> tables{
#if defined(__wasm__)
    nullptr, &baseline_bodies_4,
#else
    &baseline_bodies_1, &baseline_bodies_4,
#endif
#if defined(LENDULET_EMULATED_LANES)
    &baseline_bodies_8, &baseline_bodies_16,
#else
    nullptr, nullptr,
#endif
#if defined(__x86_64__) && !defined(LENDULET_FOUR_LANES)
    &avx2_bodies, &avx512_bodies,
#else
    nullptr, nullptr,
#endif
};
// clang-format on

}  // namespace

const BodyKernels& body_kernels(int width) { return tables.of(width); }

}  // namespace lendulet
