// Rows to lanes: reads four or eight consecutive floats from each of W records and turns them into vectors, by
// transposing registers. Measured faster than hardware gather at every width, and the only form that also scatters.
#pragma once

#include "math/wide/wide.h"

namespace lendulet {

namespace detail {

using Float4 = Wide<float, 4>;
using Float8 = Wide<float, 8>;
using Float16 = Wide<float, 16>;

LENDULET_FORCE_INLINE Float4 interleave_low(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); }
LENDULET_FORCE_INLINE Float4 interleave_high(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); }
LENDULET_FORCE_INLINE Float4 pairs_low(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
LENDULET_FORCE_INLINE Float4 pairs_high(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
LENDULET_FORCE_INLINE Float8 interleave_low(Float8 a, Float8 b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
}
LENDULET_FORCE_INLINE Float8 interleave_high(Float8 a, Float8 b) {
    return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
}
LENDULET_FORCE_INLINE Float8 pairs_low(Float8 a, Float8 b) {
    return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
}
LENDULET_FORCE_INLINE Float8 pairs_high(Float8 a, Float8 b) {
    return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
}
LENDULET_FORCE_INLINE Float16 interleave_low(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
LENDULET_FORCE_INLINE Float16 interleave_high(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
LENDULET_FORCE_INLINE Float16 pairs_low(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}
LENDULET_FORCE_INLINE Float16 pairs_high(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}
// Two halves to one register. By intrinsics where there are any: GCC makes a load, a copy and a two-operand shuffle of
// the general form, where one insertion from memory does.
LENDULET_FORCE_INLINE Float8 join(Float4 a, Float4 b) {
#if defined(__AVX__)
    return (Float8)_mm256_insertf128_ps(_mm256_castps128_ps256((__m128)a), (__m128)b, 1);
#else
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}
LENDULET_FORCE_INLINE Float16 join(Float8 a, Float8 b) {
#if defined(__AVX512DQ__)
    return (Float16)_mm512_insertf32x8(_mm512_castps256_ps512((__m256)a), (__m256)b, 1);
#else
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}
// Even or odd quads of both.
LENDULET_FORCE_INLINE Float16 even_quads(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
}
LENDULET_FORCE_INLINE Float16 odd_quads(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
}
// The quads of a pair in turns: a0 b0 a1 b1 and a2 b2 a3 b3.
LENDULET_FORCE_INLINE Float16 quads_low(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
}
LENDULET_FORCE_INLINE Float16 quads_high(Float16 a, Float16 b) {
    return __builtin_shufflevector(a, b, 8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
}

// Transposes every 4 x 4 block of 128-bit lanes.
template <class F>
LENDULET_FORCE_INLINE void transpose4(F& a, F& b, F& c, F& d) {
    F ab_low = interleave_low(a, b), ab_high = interleave_high(a, b);
    F cd_low = interleave_low(c, d), cd_high = interleave_high(c, d);
    a = pairs_low(ab_low, cd_low);
    b = pairs_high(ab_low, cd_low);
    c = pairs_low(ab_high, cd_high);
    d = pairs_high(ab_high, cd_high);
}

LENDULET_FORCE_INLINE Float4 load_quad(const float* p) { return load_wide<Float4>(p); }

#if defined(__AVX512F__)
inline constexpr int native_lanes = 16;
#elif defined(__AVX__)
inline constexpr int native_lanes = 8;
#else
inline constexpr int native_lanes = 4;
#endif

}  // namespace detail

// The floats of a record, for gather4 and scatter4 over an array of them.
template <class Record>
LENDULET_FORCE_INLINE const float* floats_of(const Record* records) {
    return reinterpret_cast<const float*>(records);
}
template <class Record>
LENDULET_FORCE_INLINE float* floats_of(Record* records) {
    return reinterpret_cast<float*>(records);
}

// out[k] lane i = quad(i)[k], k = 0 .. 3.
template <int W, class Quad>
LENDULET_FORCE_INLINE void transpose_quads(Quad&& quad, Wide<float, W> out[4]) {
    using namespace detail;
    if constexpr (W == 1) {
        const Float4 q = quad(0);
        for (int k = 0; k < 4; ++k) out[k] = q[k];
    } else if constexpr (W > native_lanes) {  // wider than this unit's registers: by native quads, through memory
        float lanes[4][W];
        for (int i = 0; i < W; i += 4) {
            Float4 q[4] = {quad(i), quad(i + 1), quad(i + 2), quad(i + 3)};
            transpose4(q[0], q[1], q[2], q[3]);
            for (int k = 0; k < 4; ++k) store_wide(lanes[k] + i, q[k]);
        }
        for (int k = 0; k < 4; ++k) out[k] = load_wide<Wide<float, W>>(lanes[k]);
    } else {
        for (int k = 0; k < 4; ++k) {
            if constexpr (W == 4) out[k] = quad(k);
            else if constexpr (W == 8) out[k] = join(quad(k), quad(k + 4));
            else out[k] = join(join(quad(k), quad(k + 4)), join(quad(k + 8), quad(k + 12)));
        }
        transpose4(out[0], out[1], out[2], out[3]);
    }
}

// out[k] lane i = base[index[i] * stride + offset + k], k = 0 .. 3; stride and offset in floats.
template <int W>
LENDULET_FORCE_INLINE void gather4(const float* base, const int32_t* index, int stride, int offset,
                                   Wide<float, W> out[4]) {
    if constexpr (W == 1) {
        const float* p = base + static_cast<ptrdiff_t>(index[0]) * stride + offset;
        for (int k = 0; k < 4; ++k) out[k] = p[k];
    } else {
        transpose_quads<W>(
            [&](int i) { return detail::load_quad(base + static_cast<ptrdiff_t>(index[i]) * stride + offset); }, out);
    }
}

// The inverse of gather4; lanes that share an index must hold the same values.
template <int W>
LENDULET_FORCE_INLINE void scatter4(float* base, const int32_t* index, int stride, int offset,
                                    const Wide<float, W> in[4]) {
    using namespace detail;
    if constexpr (W == 1) {
        // By bytes: where it leads to records also hold whole numbers, which are read as such.
        std::memcpy(base + static_cast<ptrdiff_t>(index[0]) * stride + offset, in, 4 * sizeof(float));
    } else if constexpr (W > native_lanes) {
        float lanes[4][W];
        for (int k = 0; k < 4; ++k) store_wide(lanes[k], in[k]);
        for (int i = 0; i < W; i += 4) {
            Float4 q[4];
            for (int k = 0; k < 4; ++k) q[k] = load_quad(lanes[k] + i);
            transpose4(q[0], q[1], q[2], q[3]);
            for (int k = 0; k < 4; ++k) store_wide(base + static_cast<ptrdiff_t>(index[i + k]) * stride + offset, q[k]);
        }
    } else {
        Wide<float, W> r[4] = {in[0], in[1], in[2], in[3]};
        transpose4(r[0], r[1], r[2], r[3]);
        auto put = [&](int i, Float4 v) { store_wide(base + static_cast<ptrdiff_t>(index[i]) * stride + offset, v); };
        for (int k = 0; k < 4; ++k) {
            if constexpr (W == 4) {
                put(k, r[k]);
            } else {
                put(k, __builtin_shufflevector(r[k], r[k], 0, 1, 2, 3));
                put(k + 4, __builtin_shufflevector(r[k], r[k], 4, 5, 6, 7));
                if constexpr (W == 16) {
                    put(k + 8, __builtin_shufflevector(r[k], r[k], 8, 9, 10, 11));
                    put(k + 12, __builtin_shufflevector(r[k], r[k], 12, 13, 14, 15));
                }
            }
        }
    }
}

// As gather4, of eight floats: wide registers take half as many loads and four fifths of the shuffles.
template <int W>
LENDULET_FORCE_INLINE void gather8(const float* base, const int32_t* index, int stride, int offset,
                                   Wide<float, W> out[8]) {
    using namespace detail;
    if constexpr (W == 16 && W <= native_lanes) {
        auto half = [&](int i) { return load_wide<Float8>(base + static_cast<ptrdiff_t>(index[i]) * stride + offset); };
        Float16 low[4], high[4];
        for (int k = 0; k < 4; ++k) {
            low[k] = join(half(k), half(k + 4));
            high[k] = join(half(k + 8), half(k + 12));
        }
        transpose4(low[0], low[1], low[2], low[3]);
        transpose4(high[0], high[1], high[2], high[3]);
        for (int k = 0; k < 4; ++k) {
            out[k] = even_quads(low[k], high[k]);
            out[k + 4] = odd_quads(low[k], high[k]);
        }
    } else {
        gather4<W>(base, index, stride, offset, out);
        gather4<W>(base, index, stride, offset + 4, out + 4);
    }
}

// The inverse of gather8, see scatter4.
template <int W>
LENDULET_FORCE_INLINE void scatter8(float* base, const int32_t* index, int stride, int offset,
                                    const Wide<float, W> in[8]) {
    using namespace detail;
    if constexpr (W == 16 && W <= native_lanes) {
        Float16 low[4], high[4];
        for (int k = 0; k < 4; ++k) {
            low[k] = quads_low(in[k], in[k + 4]);
            high[k] = quads_high(in[k], in[k + 4]);
        }
        transpose4(low[0], low[1], low[2], low[3]);
        transpose4(high[0], high[1], high[2], high[3]);
        asm volatile("" : "+r"(index));  // fresh loads of the indices: kept ones would be spilled
        auto put = [&](int i, Float8 v) { store_wide(base + static_cast<ptrdiff_t>(index[i]) * stride + offset, v); };
        for (int k = 0; k < 4; ++k) {
            put(k, __builtin_shufflevector(low[k], low[k], 0, 1, 2, 3, 4, 5, 6, 7));
            put(k + 4, __builtin_shufflevector(low[k], low[k], 8, 9, 10, 11, 12, 13, 14, 15));
            put(k + 8, __builtin_shufflevector(high[k], high[k], 0, 1, 2, 3, 4, 5, 6, 7));
            put(k + 12, __builtin_shufflevector(high[k], high[k], 8, 9, 10, 11, 12, 13, 14, 15));
        }
    } else {
        scatter4<W>(base, index, stride, offset, in);
        scatter4<W>(base, index, stride, offset + 4, in + 4);
    }
}

// Four consecutive floats of W consecutive records.
template <int W>
LENDULET_FORCE_INLINE void load4(const float* base, int first, int stride, int offset, Wide<float, W> out[4]) {
    int32_t index[W];
    for (int i = 0; i < W; ++i) index[i] = first + i;
    gather4<W>(base, index, stride, offset, out);
}
template <int W>
LENDULET_FORCE_INLINE void store4(float* base, int first, int stride, int offset, const Wide<float, W> in[4]) {
    int32_t index[W];
    for (int i = 0; i < W; ++i) index[i] = first + i;
    scatter4<W>(base, index, stride, offset, in);
}

}  // namespace lendulet
