// Joint kernels of width 8 in the instructions every machine has; see solver/kernels_baseline_8.cpp.
#define LENDULET_KERNEL_SPACE joints_baseline_8
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable baseline_joints_8;
constexpr JointTable baseline_joints_8 = joints_baseline_8::make_joint_table<8>();

}  // namespace lendulet
