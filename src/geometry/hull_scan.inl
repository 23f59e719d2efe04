// The search over the corners of a hull for one width of vectors; stands within an unnamed namespace of each
// instruction set. All widths give the same: lanes compute the same products and sums, and the largest of them is
// exact.

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Found {
    float value;
    uint32_t index;
};

template <class F>
LENDULET_FORCE_INLINE float largest_lane(F a) {
    if constexpr (lanes_of<F> == 8)
        return largest_lane(maximum(Wide<float, 4>{a[0], a[1], a[2], a[3]}, Wide<float, 4>{a[4], a[5], a[6], a[7]}));
    else return maximum(maximum(a[0], a[1]), maximum(a[2], a[3]));
}

// The largest of `count` dot products, and where it stands first. They stay in registers or close by, so that nothing
// is computed twice, and no branch depends on where the largest one is.
template <class F, int count>
LENDULET_FORCE_INLINE Found scan_some(const float* xs, const float* ys, const float* zs, uint32_t first,
                                      Vec3 direction) {
    constexpr int lanes = lanes_of<F>, vectors = count / lanes, chains = vectors < 4 ? vectors : 4;
    const Vec3T<F> d{repeat<F>(direction.x), repeat<F>(direction.y), repeat<F>(direction.z)};
    F value[vectors];
    for (int i = 0; i < vectors; ++i)
        value[i] = load_wide<F>(xs + i * lanes) * d.x + load_wide<F>(ys + i * lanes) * d.y +
                   load_wide<F>(zs + i * lanes) * d.z;
    F top[chains];
    for (int i = 0; i < chains; ++i) top[i] = value[i];
    for (int i = chains; i < vectors; ++i) top[i % chains] = maximum(value[i], top[i % chains]);
    for (int i = 1; i < chains; ++i) top[0] = maximum(top[i], top[0]);
    const float best = largest_lane(top[0]);
    const F wanted = repeat<F>(best);
    uint64_t hits = 0;
    for (int i = 0; i < vectors; ++i) hits |= static_cast<uint64_t>(mask_bits(value[i] == wanted)) << (lanes * i);
    // No hit: the direction is not finite.
    return {best, hits != 0 ? first + static_cast<uint32_t>(std::countr_zero(hits)) : first};
}

// Of the dot products from `first` on up to `last`, both multiples of 16; the arrays begin at `first`.
template <class F>
LENDULET_FORCE_INLINE Found scan(const float* xs, const float* ys, const float* zs, uint32_t first, uint32_t last,
                                 Vec3 d) {
    Found best{-infinity, first};
    for (;; first += 64, xs += 64, ys += 64, zs += 64) {
        Found found;
        switch (last - first) {
            case 0:
                return best;
            case 16:
                found = scan_some<F, 16>(xs, ys, zs, first, d);
                break;
            case 32:
                found = scan_some<F, 32>(xs, ys, zs, first, d);
                break;
            case 48:
                found = scan_some<F, 48>(xs, ys, zs, first, d);
                break;
            default:
                found = scan_some<F, 64>(xs, ys, zs, first, d);
        }
        if (found.value > best.value) best = found;
        if (last - first <= 64) return best;
    }
}
