// Joint kernels of width 16 in the instructions every machine has; see solver/kernels_baseline_16.cpp.
#define LENDULET_KERNEL_SPACE joints_baseline_16
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable baseline_joints_16;
constexpr JointTable baseline_joints_16 = joints_baseline_16::make_joint_table<16>();

}  // namespace lendulet
