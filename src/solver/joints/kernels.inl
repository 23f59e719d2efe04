// The one source of all joint kernels; see solver/kernels.inl.
#include <type_traits>

#include "math/turned.h"
#include "math/wide/gather.h"
#include "math/wide/trigonometry.h"
#include "math/wide/wide.h"
#include "solver/joints/kernels.h"
#include "solver/kernels.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

#include "solver/contact_rows.inl"

#include "solver/joints/block.inl"

#include "solver/joints/rows.inl"

#include "solver/joints/passes.inl"

#include "solver/joints/records.inl"

template <int W, JointClass C>
constexpr JointKernels make_kernels_of() {
    return {sizeof(JointRow<W, C>),  sizeof(JointFrames<W, C>), load_joints<W, C>,       prepare_joints<W, C>,
            warm_start_joints<W, C>, run_joints<W, C, true>,    run_joints<W, C, false>, store_joints<W, C>};
}

template <int W>
constexpr JointTable make_joint_table() {
    return {W,
            {make_kernels_of<W, JointClass::ball>(), make_kernels_of<W, JointClass::limited_ball>(),
             make_kernels_of<W, JointClass::rubbing_ball>(), make_kernels_of<W, JointClass::hinge>(),
             make_kernels_of<W, JointClass::limited_hinge>(), make_kernels_of<W, JointClass::driven_hinge>(),
             make_kernels_of<W, JointClass::slider>(), make_kernels_of<W, JointClass::driven_slider>(),
             make_kernels_of<W, JointClass::fixed>(), make_kernels_of<W, JointClass::six_degrees>()}};
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
