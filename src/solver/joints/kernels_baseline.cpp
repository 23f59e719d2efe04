// Joint kernels in the instructions every machine has, four lanes.
#define LENDULET_KERNEL_SPACE joints_baseline
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable baseline_joints_4;
constexpr JointTable baseline_joints_4 = joints_baseline::make_joint_table<4>();

}  // namespace lendulet
