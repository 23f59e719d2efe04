// Narrow-phase kernels in the instructions every machine has, one lane and four.
#define LENDULET_KERNEL_SPACE narrow_baseline
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels baseline_narrow_1, baseline_narrow_4;
#if !defined(__wasm__)
constexpr NarrowKernels baseline_narrow_1 = narrow_baseline::make_narrow_kernels<1>();
#endif
constexpr NarrowKernels baseline_narrow_4 = narrow_baseline::make_narrow_kernels<4>();

}  // namespace lendulet
