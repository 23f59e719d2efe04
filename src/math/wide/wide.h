// Wide<float, W>: W floats that a kernel treats as one number. One source for every instruction set, from the vector
// extensions of GCC and Clang; W = 1 is a plain float, so a kernel is also its own scalar reference.
//
// Every operation is IEEE-exact and acts lane by lane, hence the width never changes results: no reciprocal estimates,
// no fused multiply-add (built with -ffp-contract=off), and maximum(a, b) is select(a > b, a, b) everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "lendulet/math.h"

// The header of all instructions takes a second to read: files compiled for none of the wide ones do without.
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace lendulet {

namespace detail {
template <class T, int W>
struct WideType {
    typedef T Type __attribute__((vector_size(sizeof(T) * W)));
};
template <class T>
struct WideType<T, 1> {
    typedef T Type;
};
}  // namespace detail

template <class T, int W>
using Wide = typename detail::WideType<T, W>::Type;

template <class F>
inline constexpr int lanes_of = static_cast<int>(sizeof(F) / sizeof(float));
template <class F>
concept WideFloat = (sizeof(F) > sizeof(float)) && requires(F f) {
    f[0] = 0.0f;
}
&&!std::is_pointer_v<F>;

// All lanes the same.
template <class F>
LENDULET_FORCE_INLINE F splat(float x) {
    if constexpr (sizeof(F) == sizeof(float)) return x;
    else return F{} + x;
}
// All lanes the same, bit by bit: splat() adds zero, which is an instruction more, for it makes +0 of -0.
template <class F>
LENDULET_FORCE_INLINE F repeat(float x) {
    using Integers = Wide<int32_t, lanes_of<F>>;
    int32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return (F)(Integers{} + bits);
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> splat(Vec3 v) {
    return {splat<F>(v.x), splat<F>(v.y), splat<F>(v.z)};
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> zero_vector() {
    return {splat<F>(0.0f), splat<F>(0.0f), splat<F>(0.0f)};
}

// mask ? a : b, lane by lane; a mask is what a comparison gives.
LENDULET_FORCE_INLINE float select(bool mask, float a, float b) { return mask ? a : b; }
template <class M, WideFloat F>
LENDULET_FORCE_INLINE F select(M mask, F a, F b) {
    return mask ? a : b;
}
template <class M, class F>
LENDULET_FORCE_INLINE Vec3T<F> select(M mask, Vec3T<F> a, Vec3T<F> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
template <class M, class F>
LENDULET_FORCE_INLINE QuatT<F> select(M mask, QuatT<F> a, QuatT<F> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z), select(mask, a.w, b.w)};
}

// The x86 instructions are exactly these selections, NaN and -0 included.
template <WideFloat F>
LENDULET_FORCE_INLINE F maximum(F a, F b) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return (F)_mm512_max_ps((__m512)a, (__m512)b);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(F) == 32) return (F)_mm256_max_ps((__m256)a, (__m256)b);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(F) == 16) return (F)_mm_max_ps((__m128)a, (__m128)b);
#endif
    return select(a > b, a, b);
}
template <WideFloat F>
LENDULET_FORCE_INLINE F minimum(F a, F b) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return (F)_mm512_min_ps((__m512)a, (__m512)b);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(F) == 32) return (F)_mm256_min_ps((__m256)a, (__m256)b);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(F) == 16) return (F)_mm_min_ps((__m128)a, (__m128)b);
#endif
    return select(a < b, a, b);
}
template <WideFloat F>
LENDULET_FORCE_INLINE F square_root(F a) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return (F)_mm512_sqrt_ps((__m512)a);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(F) == 32) return (F)_mm256_sqrt_ps((__m256)a);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(F) == 16) return (F)_mm_sqrt_ps((__m128)a);
#elif defined(__aarch64__)
    if constexpr (sizeof(F) == 16) return (F)vsqrtq_f32((float32x4_t)a);
#endif
    F r;
    for (int i = 0; i < lanes_of<F>; ++i) r[i] = __builtin_sqrtf(a[i]);
    return r;
}
template <WideFloat F>
LENDULET_FORCE_INLINE F absolute(F a) {
    using I = Wide<int32_t, lanes_of<F>>;
    return (F)((I)a & 0x7fffffff);
}
template <WideFloat F>
LENDULET_FORCE_INLINE F length(Vec3T<F> a) {
    return square_root(dot(a, a));
}
template <WideFloat F>
LENDULET_FORCE_INLINE Vec3T<F> absolute(Vec3T<F> a) {
    return {absolute(a.x), absolute(a.y), absolute(a.z)};
}
template <WideFloat F>
LENDULET_FORCE_INLINE Vec3T<F> minimum(Vec3T<F> a, Vec3T<F> b) {
    return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
template <WideFloat F>
LENDULET_FORCE_INLINE Vec3T<F> maximum(Vec3T<F> a, Vec3T<F> b) {
    return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}

// Bit i is set where lane i of a mask is.
LENDULET_FORCE_INLINE uint32_t mask_bits(bool mask) { return mask ? 1u : 0u; }
template <class M>
requires(!std::is_same_v<M, bool>) LENDULET_FORCE_INLINE uint32_t mask_bits(M mask) {
#if defined(__AVX512DQ__)
    if constexpr (sizeof(M) == 64) return _mm512_movepi32_mask((__m512i)mask);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(M) == 32) return static_cast<uint32_t>(_mm256_movemask_ps((__m256)mask));
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(M) == 16) return static_cast<uint32_t>(_mm_movemask_ps((__m128)mask));
#elif defined(__aarch64__)
    if constexpr (sizeof(M) == 16) return vaddvq_u32((uint32x4_t)mask & uint32x4_t{1, 2, 4, 8});
#endif
    uint32_t bits = 0;
    for (int i = 0; i < lanes_of<M>; ++i) bits |= (mask[i] ? 1u : 0u) << i;
    return bits;
}

LENDULET_FORCE_INLINE float lane(float a, int) { return a; }
template <WideFloat F>
LENDULET_FORCE_INLINE float lane(F a, int i) {
    return a[i];
}
LENDULET_FORCE_INLINE void set_lane(float& a, int, float v) { a = v; }
template <WideFloat F>
LENDULET_FORCE_INLINE void set_lane(F& a, int i, float v) {
    a[i] = v;
}

template <class F>
LENDULET_FORCE_INLINE F load_wide(const float* p) {
    F f;
    std::memcpy(&f, p, sizeof f);
    return f;
}
template <class F>
LENDULET_FORCE_INLINE void store_wide(float* p, F f) {
    std::memcpy(p, &f, sizeof f);
}

}  // namespace lendulet
