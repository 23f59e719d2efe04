// Masks of lanes as a machine likes them best: a mask register where there is one, else a vector. For chains of
// comparisons, of which only the bits are wanted in the end, and for packing the lanes that passed.
#pragma once

#include "math/wide/wide.h"

namespace lendulet {

namespace detail {
template <class F>
struct MaskType {
    using Type = decltype(F{} <= F{});
};
#if defined(__AVX512F__)
template <>
struct MaskType<Wide<float, 16>> {
    using Type = __mmask16;
};
#endif

// For each set of eight lanes, those in it: lane numbers in ascending order, then zeros.
struct LanesOfByte {
    uint8_t lane[256][8];
    constexpr LanesOfByte() : lane{} {
        for (int set = 0; set < 256; ++set) {
            for (int i = 0, n = 0; i < 8; ++i) {
                if (set >> i & 1) lane[set][n++] = static_cast<uint8_t>(i);
            }
        }
    }
};
inline constexpr LanesOfByte lanes_of_byte{};
}  // namespace detail

template <class F>
using LaneMask = typename detail::MaskType<F>::Type;

// Where a <= b; and where `mask` is set and a <= b.
template <class F>
LENDULET_FORCE_INLINE LaneMask<F> at_most(F a, F b) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LE_OQ);
    else
#endif
        return a <= b;
}
template <class F>
LENDULET_FORCE_INLINE LaneMask<F> at_most(LaneMask<F> mask, F a, F b) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return _mm512_mask_cmp_ps_mask(mask, (__m512)a, (__m512)b, _CMP_LE_OQ);
    else
#endif
        return mask & (a <= b);
}
template <class F>
LENDULET_FORCE_INLINE uint32_t lane_bits(LaneMask<F> mask) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) return mask;
    else
#endif
        return mask_bits(mask);
}

// Writes the lanes of `bits` one after the other to `to`, which needs room for all lanes: what stands behind the packed
// ones is unset.
template <class F>
LENDULET_FORCE_INLINE void store_packed(float* to, uint32_t bits, F value) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) {
        _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(bits), (__m512)value));
        return;
    }
#endif
#if defined(__AVX2__)
    if constexpr (sizeof(F) == 32) {
        __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(detail::lanes_of_byte.lane[bits]));
        _mm256_storeu_ps(to, _mm256_permutevar8x32_ps((__m256)value, _mm256_cvtepu8_epi32(bytes)));
        return;
    }
#endif
    for (; bits; bits &= bits - 1) *to++ = lane(value, __builtin_ctz(bits));
}

// Writes first + i for each bit i of `bits`, rising, to `to`, which needs room for all lanes of F: what stands behind
// them is unset.
template <class F, class Integer>
LENDULET_FORCE_INLINE void store_numbers(Integer* to, uint32_t bits, Integer first) {
    static_assert(sizeof(Integer) == 4);
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) {
        const __m512i counts = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
        __m512i all = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(first)), counts);
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), all));
        return;
    }
#endif
#if defined(__AVX2__)
    if constexpr (sizeof(F) == 32) {
        __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(detail::lanes_of_byte.lane[bits]));
        __m256i all = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), _mm256_cvtepu8_epi32(bytes));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), all);
        return;
    }
#endif
    for (; bits; bits &= bits - 1) *to++ = first + static_cast<Integer>(__builtin_ctz(bits));
}

}  // namespace lendulet
