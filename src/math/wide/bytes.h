// Vectors of signed bytes: four times as many numbers in a register as floats, for tests that may err on one side. As
// with floats, the width never changes a result.
#pragma once

#include "math/wide/wide.h"

namespace lendulet {

using Bytes16 = Wide<int8_t, 16>;
// As large as a vector of floats.
template <class F>
using BytesOf = Wide<int8_t, static_cast<int>(sizeof(F))>;
template <class B>
inline constexpr int bytes_of = static_cast<int>(sizeof(B));

// The four bytes of a word, over and over.
template <class B>
LENDULET_FORCE_INLINE B repeat_word(const uint32_t& word) {
    using Words = Wide<int32_t, bytes_of<B> / 4>;
    return (B)(Words{} + static_cast<int32_t>(word));
}
LENDULET_FORCE_INLINE Bytes16 repeat_byte(int byte) {
    return repeat_word<Bytes16>(static_cast<uint32_t>(byte & 0xff) * 0x01010101u);
}
template <class B>
LENDULET_FORCE_INLINE B load_bytes(const int8_t* p) {
    B b;
    std::memcpy(&b, p, sizeof b);
    return b;
}

// Bit i is set where byte i of a mask is.
template <class M>
LENDULET_FORCE_INLINE uint32_t byte_mask_bits(M mask) {
#if defined(__AVX2__)
    if constexpr (sizeof(M) == 32) return static_cast<uint32_t>(_mm256_movemask_epi8((__m256i)mask));
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(M) == 16) return static_cast<uint32_t>(_mm_movemask_epi8((__m128i)mask));
#elif defined(__aarch64__)
    if constexpr (sizeof(M) == 16) {
        const uint8x16_t bits = (uint8x16_t)mask & uint8x16_t{1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
        return vaddv_u8(vget_low_u8(bits)) | static_cast<uint32_t>(vaddv_u8(vget_high_u8(bits))) << 8;
    }
#endif
#if defined(__wasm_simd128__)
    if constexpr (sizeof(M) == 16) return static_cast<uint32_t>(__builtin_wasm_bitmask_i8x16((Bytes16)mask));
#endif
    uint32_t bits = 0;
    for (int i = 0; i < bytes_of<M>; ++i) bits |= (mask[i] ? 1u : 0u) << i;
    return bits;
}

// Byte by byte, whether all of several comparisons a <= b hold.
template <class B>
class AllAtMost {
public:
    LENDULET_FORCE_INLINE void require(B a, B b) {
#if defined(__AVX512BW__)
        if constexpr (sizeof(B) == 64) {
            mask_ = _mm512_mask_cmple_epi8_mask(mask_, (__m512i)a, (__m512i)b);
            return;
        }
#endif
        fails_ |= (B)(a > b);
    }
    LENDULET_FORCE_INLINE uint64_t bits() const {
#if defined(__AVX512BW__)
        if constexpr (sizeof(B) == 64) return mask_;
#endif
        constexpr uint64_t all = ~uint64_t{0} >> (64 - sizeof(B));
        return all & ~uint64_t{byte_mask_bits(fails_)};
    }

private:
    B fails_{};
    uint64_t mask_ = ~uint64_t{0};
};

// The integers next to floats towards zero, as bytes; of floats from -128 to 127.
LENDULET_FORCE_INLINE Bytes16 to_bytes(Wide<float, 4> a, Wide<float, 4> b, Wide<float, 4> c, Wide<float, 4> d) {
#if defined(__SSE2__)
    __m128i low = _mm_packs_epi32(_mm_cvttps_epi32((__m128)a), _mm_cvttps_epi32((__m128)b));
    __m128i high = _mm_packs_epi32(_mm_cvttps_epi32((__m128)c), _mm_cvttps_epi32((__m128)d));
    return (Bytes16)_mm_packs_epi16(low, high);
#elif defined(__aarch64__)
    auto pair = [](Wide<float, 4> x, Wide<float, 4> y) {
        int16x4_t low = vqmovn_s32(vcvtq_s32_f32((float32x4_t)x)), high = vqmovn_s32(vcvtq_s32_f32((float32x4_t)y));
        return vqmovn_s16(vcombine_s16(low, high));
    };
    return (Bytes16)vcombine_s8(pair(a, b), pair(c, d));
#else
    Bytes16 bytes;
    for (int i = 0; i < 4; ++i) {
        bytes[i] = static_cast<int8_t>(a[i]);
        bytes[4 + i] = static_cast<int8_t>(b[i]);
        bytes[8 + i] = static_cast<int8_t>(c[i]);
        bytes[12 + i] = static_cast<int8_t>(d[i]);
    }
    return bytes;
#endif
}

// The same of sixteen floats in vectors of F.
template <class F>
LENDULET_FORCE_INLINE void store_as_bytes(int8_t* to, const F* floats) {
#if defined(__AVX512F__)
    if constexpr (sizeof(F) == 64) {
        __m128i bytes = _mm512_cvtepi32_epi8(_mm512_cvttps_epi32((__m512)*floats));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), bytes);
        return;
    }
#endif
    Wide<float, 4> quads[4];
    std::memcpy(quads, floats, sizeof quads);
    Bytes16 bytes = to_bytes(quads[0], quads[1], quads[2], quads[3]);
    std::memcpy(to, &bytes, sizeof bytes);
}

#if defined(__AVX512BW__) && defined(__AVX512VL__)
// The same of eight floats, of which those below -128 give that.
LENDULET_FORCE_INLINE Bytes16 to_bytes(Wide<float, 8> floats) {
    return (Bytes16)_mm256_cvtsepi32_epi8(_mm256_cvttps_epi32((__m256)floats));
}
// The first eight bytes over and over, and of such a vector one of the eight in all lanes.
LENDULET_FORCE_INLINE Wide<int8_t, 64> repeat_eight(Bytes16 bytes) {
    return (Wide<int8_t, 64>)_mm512_broadcastq_epi64((__m128i)bytes);
}
LENDULET_FORCE_INLINE Wide<int8_t, 64> repeat_one(Wide<int8_t, 64> eights, int which) {
    return (Wide<int8_t, 64>)_mm512_shuffle_epi8((__m512i)eights, _mm512_set1_epi8(static_cast<char>(which)));
}
#endif

// Each of the first bytes, 8 or 16 of them, four times.
template <int Count>
LENDULET_FORCE_INLINE void store_fourfold(uint32_t to[Count], Bytes16 bytes) {
    auto store = [](uint32_t* at, Bytes16 b) { std::memcpy(at, &b, sizeof b); };
    Bytes16 low = __builtin_shufflevector(bytes, bytes, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
    store(to, __builtin_shufflevector(low, low, 0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7));
    store(to + 4, __builtin_shufflevector(low, low, 8, 9, 8, 9, 10, 11, 10, 11, 12, 13, 12, 13, 14, 15, 14, 15));
    if constexpr (Count == 8) return;
    Bytes16 high = __builtin_shufflevector(bytes, bytes, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15);
    store(to + 8, __builtin_shufflevector(high, high, 0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7));
    store(to + 12, __builtin_shufflevector(high, high, 8, 9, 8, 9, 10, 11, 10, 11, 12, 13, 12, 13, 14, 15, 14, 15));
}

}  // namespace lendulet
