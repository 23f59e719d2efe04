// Joint kernels in the instructions every machine has, one lane and four.
#define LENDULET_KERNEL_SPACE joints_baseline
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable baseline_joints_1, baseline_joints_4;
constexpr JointTable baseline_joints_1 = joints_baseline::make_joint_table<1>();
constexpr JointTable baseline_joints_4 = joints_baseline::make_joint_table<4>();

}  // namespace lendulet
