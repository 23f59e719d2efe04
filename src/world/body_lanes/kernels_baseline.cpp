// Kernels of the bodies in the instructions every machine has, one lane and four.
#define LENDULET_KERNEL_SPACE bodies_baseline
#include "world/body_lanes/kernels.inl"

namespace lendulet {

extern const BodyKernels baseline_bodies_1, baseline_bodies_4;
#if !defined(__wasm__)
constexpr BodyKernels baseline_bodies_1 = bodies_baseline::make_body_kernels<1>();
#endif
constexpr BodyKernels baseline_bodies_4 = bodies_baseline::make_body_kernels<4>();

}  // namespace lendulet
