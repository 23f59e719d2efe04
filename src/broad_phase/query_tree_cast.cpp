// The walk of casts in the instructions every machine has, and the choice of the widest one.
#define LENDULET_KERNEL_SPACE query_tree_baseline
#include "broad_phase/query_tree_cast.inl"
#include "math/wide/instruction_sets.h"

namespace lendulet {

#if defined(__x86_64__)
extern const QueryTreeCast query_tree_cast_avx2;
extern const QueryTreeCasts query_tree_casts_avx2;

QueryTreeCast query_tree_cast(int width) {
    if ((width == 0 || width >= 8) && cpu_has_avx2()) return query_tree_cast_avx2;
    return query_tree_baseline::cast_one<Wide<float, 4>>;
}
QueryTreeCasts query_tree_casts(int width) {
    if ((width == 0 || width >= 8) && cpu_has_avx2()) return query_tree_casts_avx2;
    return query_tree_baseline::cast_many<Wide<float, 4>>;
}
#else
QueryTreeCast query_tree_cast(int) { return query_tree_baseline::cast_one<Wide<float, 4>>; }
QueryTreeCasts query_tree_casts(int) { return query_tree_baseline::cast_many<Wide<float, 4>>; }
#endif

}  // namespace lendulet
