// What OverTriangleBatch asks, W triangles side by side. Included by units that define a namespace of their own for it.

namespace over_triangle {

// As clip.cpp has it: points this part of the smaller face's size outside still count as over it.
constexpr float overhang = 2e-4f;
// Sine of the angle of a face with the triangle's normal below which it is seen from the side and covers no corner.
constexpr float edge_on = 1e-3f;

template <class F, int room>
LENDULET_FORCE_INLINE Vec3T<F> load(const float (&rows)[3][room], int first) {
    return {load_wide<F>(rows[0] + first), load_wide<F>(rows[1] + first), load_wide<F>(rows[2] + first)};
}

template <int W>
struct Block {
    using F = Wide<float, W>;
    using V = Vec3T<F>;
    using I = Wide<int32_t, W>;

    OverTriangleBatch& b;
    int first;
    V vertex[3], normal, out[3];
    F offset[3], reach;
    I bits{};

    LENDULET_FORCE_INLINE Block(OverTriangleBatch& batch, int lane) : b(batch), first(lane) {
        const MeshFilterBatch& near = *b.triangles;
        const int from = b.first + first;
        for (int k = 0; k < 3; ++k) vertex[k] = load<F>(near.p[k], from);
        normal = load<F>(near.normal, from);
        const F none{}, one = splat<F>(1.0f);
        const I flags = __builtin_convertvector(load_wide<F>(near.flags + from), I);
        const F turned = select((flags & static_cast<int32_t>(MeshFilterBatch::behind)) != 0, none - one, one);
        reach = F{};
        for (int k = 0; k < 3; ++k) {
            const V across = turned * cross(vertex[(k + 1) % 3] - vertex[k], normal);
            const F size = length(across);
            reach = maximum(size, reach);
            out[k] = (splat<F>(1.0f) / size) * across;
            offset[k] = dot(out[k], vertex[k]);
        }
    }

    template <class M>
    LENDULET_FORCE_INLINE void mark(M where, int bit) {
        bits |= (I)where & (1 << bit);
    }

    LENDULET_FORCE_INLINE void place_lowest() {
        const V p = load<F>(b.triangles->lowest, b.first + first);
        const F height = dot(normal, p - vertex[0]), zero{};
        store_wide(b.lowest_height + first, height);
        const F slack = splat<F>(b.level) + splat<F>(half_gentle_tangent) * maximum(zero, -height);
        auto is_out = zero > zero;
        for (int k = 0; k < 3; ++k) {
            const F along = dot(out[k], p);
            is_out = is_out | (along > offset[k]);
            mark(~(along - offset[k] < -slack), OverTriangleBatch::first_beyond + k);
        }
        mark(~is_out, OverTriangleBatch::lowest_is_over);
    }

    LENDULET_FORCE_INLINE void put(int number, V foot, F height) {
        store_wide(b.point[number][0] + first, foot.x);
        store_wide(b.point[number][1] + first, foot.y);
        store_wide(b.point[number][2] + first, foot.z);
        store_wide(b.height[number] + first, height);
    }

    // Of edge k, which ends at the distances a and b inside the sides.
    template <class M>
    LENDULET_FORCE_INLINE void cut(int k, const F (&from)[3], const F (&to)[3], M valid) {
        const F zero{}, one = splat<F>(1.0f), none = splat<F>(-1.0f);
        F begin = zero, end = one, enters = none, leaves = none;
        for (int i = 0; i < 3; ++i) {
            const F a = from[i], z = to[i], side = splat<F>(static_cast<float>(i));
            auto a_out = a < zero, z_out = z < zero;
            valid = valid & ~(a_out & z_out);
            const F t = a / select(a_out ^ z_out, a - z, one);
            auto later = a_out & ~z_out & (t > begin), sooner = z_out & ~a_out & (t < end);
            begin = select(later, t, begin), enters = select(later, side, enters);
            end = select(sooner, t, end), leaves = select(sooner, side, leaves);
        }
        valid = valid & (begin <= end);
        if (mask_bits(valid) == 0) return;
        const V p = load<F>(b.corner[k], first), next = load<F>(b.corner[k + 1], first), along = next - p;
        const F low = dot(normal, vertex[0]), height = dot(normal, p) - low, next_height = dot(normal, next) - low,
                rise = next_height - height, limit = splat<F>(b.limit), count = load_wide<F>(b.corner_count + first);
        auto crosses = leaves > none;
        const F first_height = height + begin * rise, last_height = select(crosses, height + end * rise, next_height);
        store_wide(b.side[2 * k] + first, enters);
        store_wide(b.side[2 * k + 1] + first, leaves);
        put(2 * k, p + begin * along - first_height * normal, first_height);
        put(2 * k + 1, select(crosses, p + end * along, next) - last_height * normal, last_height);
        mark(valid & (first_height <= limit), 2 * k);
        // The end of an edge is where the next begins, but for that of a line.
        mark(valid & (crosses | (count == splat<F>(2.0f))) & (last_height <= limit), 2 * k + 1);
    }

    // Corners of the triangle that the face covers, seen along the triangle's normal.
    template <class M>
    LENDULET_FORCE_INLINE void cover(M valid) {
        const V face_normal = load<F>(b.face_normal, first), origin = load<F>(b.corner[0], first);
        const F slope = dot(face_normal, normal), zero{}, count = load_wide<F>(b.corner_count + first);
        valid = valid & (slope < splat<F>(-edge_on)) & (count > splat<F>(2.0f));
        if (mask_bits(valid) == 0) return;
        decltype(valid) covered[3] = {valid, valid, valid};
        for (int k = 0; k < b.corners; ++k) {
            const V p = load<F>(b.corner[k], first), inwards = cross(load<F>(b.corner[k + 1], first) - p, normal);
            auto there = splat<F>(static_cast<float>(k)) < count;
            for (int c = 0; c < 3; ++c) covered[c] = covered[c] & ~(there & (dot(vertex[c] - p, inwards) < zero));
        }
        for (int c = 0; c < 3; ++c) {
            const int number = OverTriangleBatch::first_covered + c;
            if (mask_bits(covered[c]) == 0) continue;
            const F height = dot(face_normal, origin - vertex[c]) / slope;
            put(number, vertex[c], height);
            mark(covered[c] & (height <= splat<F>(b.limit)), number);
        }
    }

    LENDULET_FORCE_INLINE void clip() {
        const F zero{}, count = load_wide<F>(b.corner_count + first);
        const F slack = splat<F>(overhang) * minimum(reach, load_wide<F>(b.face_size + first));
        F inside[OverTriangleBatch::most_corners + 1][3];
        auto valid = count > zero;
        for (int i = 0; i < 3; ++i) {
            const F limit = offset[i] + slack;
            auto outside = zero <= zero;
            for (int k = 0; k <= b.corners; ++k) {
                inside[k][i] = limit - dot(out[i], load<F>(b.corner[k], first));
                outside = outside & ((inside[k][i] < zero) | (splat<F>(static_cast<float>(k)) > count));
            }
            valid = valid & ~outside;
        }
        if (mask_bits(valid) == 0) return;
        for (int k = 0; k < b.corners; ++k) {
            // A line is one edge.
            auto there = (splat<F>(static_cast<float>(k)) < count);
            if (k == 1) there = there & (count > splat<F>(2.0f));
            cut(k, inside[k], inside[k + 1], valid & there);
        }
        cover(valid);
    }
};

}  // namespace over_triangle

template <int W>
void clip_over_triangles(OverTriangleBatch& batch) {
    for (int first = 0; first < batch.count; first += W) {
        over_triangle::Block<W> block(batch, first);
        block.place_lowest();
        block.clip();
        std::memcpy(batch.bits + first, &block.bits, sizeof block.bits);
    }
}
