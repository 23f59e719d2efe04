#include "solver/joints/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const JointTable baseline_joints_1, baseline_joints_4, baseline_joints_8, baseline_joints_16;
extern const JointTable avx2_joints, avx512_joints;

namespace {

// clang-format off
constexpr KernelTables<JointTable> tables{
#if defined(__wasm__)
    nullptr, &baseline_joints_4,  // see solver/kernels.cpp
#else
    &baseline_joints_1, &baseline_joints_4,
#endif
#if defined(LENDULET_EMULATED_LANES)
    &baseline_joints_8, &baseline_joints_16,
#else
    nullptr, nullptr,
#endif
#if defined(__x86_64__) && !defined(LENDULET_FOUR_LANES)
    &avx2_joints, &avx512_joints,
#else
    nullptr, nullptr,
#endif
};
// clang-format on

}  // namespace

const JointTable& joint_table(int width) { return tables.of(width); }

}  // namespace lendulet
