// Kernels of the bodies of width 16 in the instructions every machine has, cut into native vectors by the compiler: to
// compare widths on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE bodies_baseline_16
#include "world/body_lanes/kernels.inl"

namespace lendulet {

extern const BodyKernels baseline_bodies_16;
constexpr BodyKernels baseline_bodies_16 = bodies_baseline_16::make_body_kernels<16>();

}  // namespace lendulet
