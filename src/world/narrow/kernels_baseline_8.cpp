// Narrow-phase kernels of width 8 in the instructions every machine has, cut into native vectors by the compiler: to
// compare widths on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE narrow_baseline_8
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels baseline_narrow_8;
constexpr NarrowKernels baseline_narrow_8 = narrow_baseline_8::make_narrow_kernels<8>();

}  // namespace lendulet
