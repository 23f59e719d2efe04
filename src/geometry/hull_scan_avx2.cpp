// The search over the corners of a hull eight at a time, for machines with AVX2; compiled with that instruction set,
// see src/CMakeLists.txt.
#if defined(__AVX2__)
#include <bit>
#include <cstdint>
#include <limits>

#include "math/wide/wide.h"

namespace lendulet {
namespace {

#include "geometry/hull_scan.inl"

}  // namespace

uint32_t farthest_avx2(const float* xs, const float* ys, const float* zs, uint32_t count, Vec3 d);
uint32_t farthest_avx2(const float* xs, const float* ys, const float* zs, uint32_t count, Vec3 d) {
    return scan<Wide<float, 8>>(xs, ys, zs, 0, count, d).index;
}

}  // namespace lendulet
#endif
