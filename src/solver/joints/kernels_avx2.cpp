// Joint kernels of width 8 for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE joints_avx2
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable avx2_joints;
constexpr JointTable avx2_joints = joints_avx2::make_joint_table<8>();

}  // namespace lendulet
#endif
