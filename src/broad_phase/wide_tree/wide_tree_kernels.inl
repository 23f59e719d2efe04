// The one source of the inner loops of the wide tree. Included by one unit per instruction set, which defines
// LENDULET_KERNEL_SPACE: the namespace that keeps the copies apart, so that the linker can never give a unit the code
// of a wider machine. F is the vector of the unit's width.
#include "base/prefetch.h"
#include "broad_phase/wide_tree/wide_tree_kernels.h"
#include "math/unbranched.h"
#include "math/wide/bytes.h"
#include "math/wide/gather.h"
#include "math/wide/mask.h"
#include "math/wide/quads.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

constexpr uint64_t all_lanes = ~uint64_t{0};

// Of no lanes: any number.
LENDULET_FORCE_INLINE uint64_t lowest_lane(uint64_t lanes) {
#if defined(__BMI__)
    return _tzcnt_u64(lanes);
#else
    return static_cast<uint64_t>(__builtin_ctzll(lanes | uint64_t{1} << 63));
#endif
}

LENDULET_FORCE_INLINE int take_lane(uint64_t& lanes) {
    int lane = __builtin_ctzll(lanes);
    lanes &= lanes - 1;
    return lane;
}

#include "broad_phase/wide_tree/wide_tree_bounds.inl"

#include "broad_phase/wide_tree/wide_tree_pairs.inl"

#include "broad_phase/wide_tree/wide_tree_batch.inl"

#include "broad_phase/wide_tree/wide_tree_changes.inl"

#include "broad_phase/wide_tree/wide_tree_queries.inl"

template <class F>
constexpr WideTreeKernels make_wide_tree_kernels() {
    return {lanes_of<F>,   fill_group<F>,         bounds_of_group<F>,      bounds_of_block<F>,
            find_pairs<F>, take_over<F>,          find_changes<F>,         find_overlapping<F>,
            find_hits<F>,  find_best<F, BoxCast>, find_best<F, NearestBox>};
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
