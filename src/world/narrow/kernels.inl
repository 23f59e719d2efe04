// The one source of the narrow phase's wide kernels. Included by one unit per instruction set, which defines
// LENDULET_KERNEL_SPACE: the namespace that keeps the copies apart, so that the linker can never give a unit the code
// of a wider machine.
#include <type_traits>

#include "base/prefetch.h"
#include "geometry/hull.h"
#include "math/turned.h"
#include "math/wide/gather.h"
#include "math/wide/mask.h"
#include "math/wide/wide.h"
#include "world/narrow/kernels.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

#include "collision/batch/boxes.inl"

#include "collision/batch/round.inl"

#include "collision/mesh/filter.inl"

#include "collision/mesh/over_triangle.inl"

#include "world/narrow/recycle.inl"

template <int W>
constexpr NarrowKernels make_narrow_kernels() {
    return {W,
            test_motion<W>,
            refresh<W>,
            collide_boxes<W>,
            collide_segments<W>,
            collide_box_balls<W>,
            filter_triangles<(W < 4 ? 4 : W)>,
            clip_over_triangles<(W < 4 ? 4 : W)>};
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
