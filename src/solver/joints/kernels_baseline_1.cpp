// Joint kernels of one lane: for what no colour has room for, and to compare widths.
#if !defined(__wasm__)
#define LENDULET_KERNEL_SPACE joints_baseline_one
#include "solver/joints/kernels.inl"

namespace lendulet {

extern const JointTable baseline_joints_1;
constexpr JointTable baseline_joints_1 = joints_baseline_one::make_joint_table<1>();

}  // namespace lendulet
#endif
