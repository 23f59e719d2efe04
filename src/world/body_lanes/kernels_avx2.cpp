// Kernels of the bodies of width 8 for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE bodies_avx2
#include "world/body_lanes/kernels.inl"

namespace lendulet {

extern const BodyKernels avx2_bodies;
constexpr BodyKernels avx2_bodies = bodies_avx2::make_body_kernels<8>();

}  // namespace lendulet
#endif
