// Narrow-phase kernels of width 16 in the instructions every machine has, cut into native vectors by the compiler: to
// compare widths on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE narrow_baseline_16
#include "world/narrow/kernels.inl"

namespace lendulet {

extern const NarrowKernels baseline_narrow_16;
constexpr NarrowKernels baseline_narrow_16 = narrow_baseline_16::make_narrow_kernels<16>();

}  // namespace lendulet
