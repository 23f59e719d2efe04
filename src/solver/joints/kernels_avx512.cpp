// Joint kernels of width 16 for machines with AVX-512; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX512F__)
#define LENDULET_KERNEL_SPACE joints_avx512
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable avx512_joints;
constexpr JointTable avx512_joints = joints_avx512::make_joint_table<16>();

}  // namespace lendulet
#endif
