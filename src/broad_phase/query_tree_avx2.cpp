// The walk of casts, 8 lanes, for machines with AVX2; compiled with that instruction set, see src/CMakeLists.txt.
#if defined(__AVX2__)
#define LENDULET_KERNEL_SPACE query_tree_avx2
#include "broad_phase/query_tree_cast.inl"

namespace lendulet {

extern const QueryTreeCast query_tree_cast_avx2;
extern const QueryTreeCasts query_tree_casts_avx2;
constexpr QueryTreeCast query_tree_cast_avx2 = query_tree_avx2::cast_one<Wide<float, 8>>;
constexpr QueryTreeCasts query_tree_casts_avx2 = query_tree_avx2::cast_many<Wide<float, 8>>;

}  // namespace lendulet
#endif
