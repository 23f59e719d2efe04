#include "solver/joints/kernels.h"

namespace lendulet {

extern const JointTable baseline_joints_1, baseline_joints_4, baseline_joints_8, baseline_joints_16;

#if defined(__x86_64__)
extern const JointTable avx2_joints, avx512_joints;
namespace {
bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2"); }
bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
}  // namespace

const JointTable& joint_table(int width) {
    if (width == 16) return has_avx512() ? avx512_joints : baseline_joints_16;
    if (width == 8) return has_avx2() ? avx2_joints : baseline_joints_8;
    return width == 4 ? baseline_joints_4 : baseline_joints_1;
}
#else
const JointTable& joint_table(int width) {
    return width == 16  ? baseline_joints_16
           : width == 8 ? baseline_joints_8
           : width == 4 ? baseline_joints_4
                        : baseline_joints_1;
}
#endif

}  // namespace lendulet
