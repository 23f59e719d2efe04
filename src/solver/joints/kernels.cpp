#include "solver/joints/kernels.h"

#include "math/wide/instruction_sets.h"

namespace lendulet {

extern const JointTable baseline_joints_1, baseline_joints_4, baseline_joints_8, baseline_joints_16;
#if defined(__x86_64__)
extern const JointTable avx2_joints, avx512_joints;
#endif

#if defined(__wasm__)
const JointTable& joint_table(int width) { return width == 1 ? baseline_joints_1 : baseline_joints_4; }
#else
const JointTable& joint_table(int width) {
#if defined(__x86_64__)
    const JointTable *avx2 = &avx2_joints, *avx512 = &avx512_joints;
#else
    const JointTable *avx2 = nullptr, *avx512 = nullptr;
#endif
    return table_for_width(width, baseline_joints_1, baseline_joints_4, baseline_joints_8, baseline_joints_16, avx2,
                           avx512);
}
#endif

}  // namespace lendulet
