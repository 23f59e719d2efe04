// Kernels of the bodies of width 8 in the instructions every machine has, cut into native vectors by the compiler: to
// compare widths on machines without the wider instructions.
#define LENDULET_KERNEL_SPACE bodies_baseline_8
#include "world/body_lanes/kernels.inl"

namespace lendulet {

extern const BodyKernels baseline_bodies_8;
constexpr BodyKernels baseline_bodies_8 = bodies_baseline_8::make_body_kernels<8>();

}  // namespace lendulet
