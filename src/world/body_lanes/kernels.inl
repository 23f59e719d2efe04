// The one source of the bodies' wide kernels. Included by one unit per instruction set, which defines
// LENDULET_KERNEL_SPACE: the namespace that keeps the copies apart, so that the linker can never give a unit the code
// of a wider machine.
#include <cstddef>

#include "math/kept_sum.h"
#include "math/wide/gather.h"
#include "math/wide/wide.h"
#include "world/body_lanes/kernels.h"
#include "world/limits.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

#include "world/body_lanes/lanes.inl"

#include "world/body_lanes/bound.inl"

#include "world/body_lanes/pack.inl"

#include "world/body_lanes/unpack.inl"

template <int W>
constexpr BodyKernels make_body_kernels() {
    return {W, bound_colliders<W>, pack_lanes<W>, unpack_lanes<W>};
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
