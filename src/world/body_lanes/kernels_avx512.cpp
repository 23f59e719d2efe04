// Kernels of the bodies of width 16 for machines with AVX512; compiled with that instruction set, see
// src/CMakeLists.txt.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE bodies_avx512
#include "world/body_lanes/kernels.inl"

namespace lendulet {

extern const BodyKernels avx512_bodies;
constexpr BodyKernels avx512_bodies = bodies_avx512::make_body_kernels<16>();

}  // namespace lendulet
#endif
