// The walk of casts in the instructions every machine has, and the choice of the widest one.
#define LENDULET_KERNEL_SPACE query_tree_baseline
#include "broad_phase/query_tree_cast.inl"
#include "math/wide/instruction_sets.h"

namespace lendulet {

#if defined(__x86_64__)
extern const QueryTreeCasts query_tree_casts_avx2;
#endif

const QueryTreeCasts& query_tree_casts([[maybe_unused]] int width) {
#if defined(__x86_64__)
    if ((width == 0 || width >= 8) && cpu_has_avx2()) return query_tree_casts_avx2;
#endif
    static constexpr QueryTreeCasts baseline = query_tree_baseline::make_query_tree_casts<Wide<float, 4>>();
    return baseline;
}

}  // namespace lendulet
