// Two sharp boxes, W pairs side by side: all separating axes without early exit, then the incident face clipped by the
// reference face, or the point between two edges. Included by units that define LENDULET_KERNEL_SPACE, or by one that
// needs a single lane, inside a namespace of their own.

#include "collision/batch/box_axes.inl"

#include "collision/batch/box_faces.inl"

// Lanes of one block of manifolds on their way to memory.
template <class F>
struct WideManifold {
    Vec3T<F> normal;
    F follow, count;
    Vec3T<F> position[4];
    F separation[4], name[4];
};

#include "collision/batch/box_ends.inl"

// Whole numbers as integers, whose bits then travel as floats. Where the mask holds the halves are exchanged: A's
// feature belongs in the upper one.
LENDULET_FORCE_INLINE float integer_bits(float x, bool exchanged) {
    const auto name = static_cast<uint32_t>(static_cast<int32_t>(x));
    return __builtin_bit_cast(float, exchanged ? name << 16 | name >> 16 : name);
}
template <WideFloat F, class M>
LENDULET_FORCE_INLINE F integer_bits(F x, M exchanged) {
    using I = Wide<int32_t, lanes_of<F>>;
    using U = Wide<uint32_t, lanes_of<F>>;
    const U name = (U) __builtin_convertvector(x, I);
    return select(exchanged, (F)(name << 16 | name >> 16), (F)name);
}

template <int W>
LENDULET_FORCE_INLINE void store_manifolds(BatchManifold* out, const int32_t* index, Wide<float, W> exchanged,
                                           const WideManifold<Wide<float, W>>& m) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(BatchManifold) / sizeof(float);
    const F zero = splat<F>(0.0f);
    float* base = floats_of(out);
    const F head[4] = {m.normal.x, m.normal.y, m.normal.z, m.follow};
    scatter4<W>(base, index, stride, 0, head);
    for (int i = 0; i < 4; ++i) {
        const F point[4] = {m.position[i].x, m.position[i].y, m.position[i].z, m.separation[i]};
        scatter4<W>(base, index, stride, 4 + 4 * i, point);
    }
    auto of_b = exchanged > zero;
    const F ids[4] = {integer_bits(m.name[0], of_b), integer_bits(m.name[1], of_b), integer_bits(m.name[2], of_b),
                      integer_bits(m.name[3], of_b)};
    scatter4<W>(base, index, stride, 20, ids);
    const F tail[4] = {integer_bits(m.count, zero > zero), zero, zero, zero};
    scatter4<W>(base, index, stride, 24, tail);
}
static_assert(offsetof(BatchManifold, id) == 20 * sizeof(float) &&
              offsetof(BatchManifold, count) == 24 * sizeof(float) &&
              offsetof(BatchManifold, passes) == 27 * sizeof(float));

// One block of a list: the pairs, and their boxes with the reference box first.
template <int W>
struct ListBlock {
    int32_t pair[W], first[W], second[W], a[W];
    alignas(64) float margin[W], way[W], axis[W], exchanged[W];
    LENDULET_FORCE_INLINE ListBlock(const BoxBatch& batch, const int32_t* list) {
        for (int l = 0; l < W; ++l) {
            const int32_t k = list[l], number = static_cast<int32_t>(batch.feature[k]) - 1;
            // Without branches: which of the two it is cannot be foreseen.
            const auto of_b = static_cast<int32_t>(static_cast<uint32_t>(number - 3) < 3u);
            const int32_t other = (batch.a[k] ^ batch.b[k]) & -of_b;
            pair[l] = k;
            a[l] = batch.a[k];
            first[l] = batch.a[k] ^ other;
            second[l] = batch.b[k] ^ other;
            margin[l] = batch.margin[k];
            way[l] = batch.way[k];
            axis[l] = static_cast<float>(number - 3 * of_b);
            exchanged[l] = static_cast<float>(of_b);
        }
    }
};

template <int W>
void face_manifolds(BoxBatch& batch, const int32_t* list, int count) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f), one = splat<F>(1.0f);
    for (int k = 0; k < count; k += W) {
        const ListBlock<W> block(batch, list + k);
        WideBox<F> reference = load_box<W>(batch.frames, block.first),
                   incident = load_box<W>(batch.frames, block.second);
        Vec3T<F> d = load_offsets<W>(batch.frames, block.first, block.second);
        F margin = load_wide<F>(block.margin), exchanged = load_wide<F>(block.exchanged);
        WideFaces<F> f = faces_of(reference, incident, d, load_wide<F>(block.axis));
        F slack_u = splat<F>(overhang) * minimum(f.half_u, absolute(f.edge_1.x) + absolute(f.edge_2.x));
        F slack_v = splat<F>(overhang) * minimum(f.half_v, absolute(f.edge_1.y) + absolute(f.edge_2.y));
        const BoxNames<F> reference_names(f.axis, f.sign), incident_names(f.incident_axis, f.incident_sign);
        Candidates<F> c;
        clip_edges(f, slack_u, slack_v, margin, reference_names, incident_names, c);
        project_corners(f, half * minimum(slack_u, slack_v), margin, reference_names, incident_names, c);
        ChosenPoint<F> chosen[4];
        WideManifold<F> m;
        m.count = choose_points(c, load_wide<F>(block.way), chosen);
        auto of_b = exchanged > half;
        m.normal = select(of_b, -f.w, f.w);
        m.follow = one - exchanged;
        // From the centre of mass of A's body to the reference shape.
        Vec3T<F> arm = load_arm<W>(batch.frames, block.a), origin = select(of_b, arm - d, arm);
        for (int i = 0; i < 4; ++i) {
            const ChosenPoint<F>& q = chosen[i];
            auto there = m.count > splat<F>(static_cast<float>(i));
            Vec3T<F> p = origin + (q.u * f.u + q.v * f.v + (f.half_w + half * q.separation) * f.w);
            m.position[i] = select(there, p, zero_vector<F>());
            m.separation[i] = select(there, q.separation, splat<F>(absent_separation));
            m.name[i] = select(there, q.name, zero);
        }
        store_manifolds<W>(batch.out, block.pair, exchanged, m);
    }
}

// --- edges

// The nearest points of the two edges whose cross product is the axis; none where they lie beyond the edges' ends,
// which happens only to boxes apart.
template <int W>
void edge_manifolds(BoxBatch& batch, const int32_t* list, int count) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), half = splat<F>(0.5f);
    auto sign_of = [&](F s) { return select(s > zero, one, zero - one); };
    for (int k = 0; k < count; k += W) {
        const ListBlock<W> block(batch, list + k);
        WideBox<F> a = load_box<W>(batch.frames, block.first), b = load_box<W>(batch.frames, block.second);
        const Vec3T<F> d = load_offsets<W>(batch.frames, block.first, block.second);
        const Vec3T<F> arm = load_arm<W>(batch.frames, block.a);
        F number = load_wide<F>(block.axis) - splat<F>(6.0f), margin = load_wide<F>(block.margin);
        F i = select(number >= splat<F>(6.0f), splat<F>(2.0f), select(number >= splat<F>(3.0f), one, zero));
        F j = number - splat<F>(3.0f) * i;
        Chooser<F> ci(i), cj(j);
        Vec3T<F> ea = ci.at(a.axis), eb = cj.at(b.axis);
        Vec3T<F> n = cross(ea, eb);
        n = (one / length(n)) * n;
        n = select(dot(n, d) < zero, -n, n);
        Vec3T<F> a1 = ci.next(a.axis), a2 = ci.last(a.axis), b1 = cj.next(b.axis), b2 = cj.last(b.axis);
        F sa1 = sign_of(dot(n, a1)), sa2 = sign_of(dot(n, a2));
        F sb1 = zero - sign_of(dot(n, b1)), sb2 = zero - sign_of(dot(n, b2));
        Vec3T<F> on_a = (sa1 * ci.next(a.half)) * a1 + (sa2 * ci.last(a.half)) * a2;
        Vec3T<F> on_b = d + ((sb1 * cj.next(b.half)) * b1 + (sb2 * cj.last(b.half)) * b2);
        Vec3T<F> gap = on_b - on_a;
        F cosine = dot(ea, eb), along_a = dot(ea, gap), along_b = dot(eb, gap);
        F inverse = one / maximum(one - cosine * cosine, splat<F>(1e-6f));
        F s = (along_a - cosine * along_b) * inverse, t = (cosine * along_a - along_b) * inverse;
        const F beyond = splat<F>(1.0f + 1e-3f);
        on_a = on_a + s * ea;
        on_b = on_b + t * eb;
        F separation = dot(on_b - on_a, n);
        auto there =
            (absolute(s) <= beyond * ci.at(a.half)) & (absolute(t) <= beyond * cj.at(b.half)) & (separation <= margin);
        WideManifold<F> m;
        m.normal = n;
        m.follow = half;
        m.count = select(there, one, zero);
        m.position[0] = arm + half * (on_a + on_b);
        m.separation[0] = separation;
        F name_a = BoxNames<F>::edge(i, sign_bit(sa1), sign_bit(sa2));
        F name_b = BoxNames<F>::edge(j, sign_bit(sb1), sign_bit(sb2));
        m.name[0] = name_of_point(name_a, name_b);
        for (int q = 1; q < 4; ++q) {
            m.position[q] = zero_vector<F>();
            m.separation[q] = splat<F>(absent_separation);
            m.name[q] = zero;
        }
        if (mask_bits(m.count > zero) != 0) {
            const F two = splat<F>(2.0f);
            const CrossingEdge<F> edge_a{
                on_a,  ea, s, ci.at(a.half), {sa1 * a1, sa2 * a2}, {two * ci.last(a.half), two * ci.next(a.half)},
                name_a};
            const CrossingEdge<F> edge_b{
                on_b,  eb, t, cj.at(b.half), {sb1 * b1, sb2 * b2}, {two * cj.last(b.half), two * cj.next(b.half)},
                name_b};
            append_ends(ends_of(edge_a, edge_b, n, separation, margin), arm, m);
        }
        store_manifolds<W>(batch.out, block.pair, load_wide<F>(block.exchanged), m);
    }
}

// Asks for the boxes of the pairs some blocks ahead of number k: they lie scattered.
template <int W>
LENDULET_FORCE_INLINE void ask_for_boxes(const BoxBatch& batch, int k) {
    constexpr int ahead = 24;
    for (int i = k + ahead; i < k + ahead + W && i < batch.count; ++i) {
        prefetch<2>(batch.frames + batch.a[i]);
        prefetch<2>(batch.frames + batch.b[i]);
    }
}

// Manifolds of a whole batch.
template <int W>
void collide_boxes(BoxBatch& batch) {
    using F = Wide<float, W>;
    int lists[2] = {0, 0};
    for (int k = 0; k < batch.count; k += W) {
        int live = batch.count - k < W ? batch.count - k : W;
        if constexpr (W > 1) ask_for_boxes<W>(batch, k);
        for (int l = live; l < W; ++l) {
            batch.a[k + l] = batch.a[k], batch.b[k + l] = batch.b[k];
            batch.feature[k + l] = batch.margin[k + l] = batch.way[k + l] = 0.0f;
        }
        WideBox<F> a = load_box<W>(batch.frames, batch.a + k), b = load_box<W>(batch.frames, batch.b + k);
        F margin = load_wide<F>(batch.margin + k);
        Vec3T<F> d = load_offsets<W>(batch.frames, batch.a + k, batch.b + k);
        BestAxis<F> best = best_axis(a, b, d, load_wide<F>(batch.feature + k), load_wide<F>(batch.way + k));
        const uint32_t near = mask_bits(best.clearance <= margin) & ((1u << live) - 1u);
        const uint32_t by_edge = mask_bits(best.axis >= splat<F>(6.0f));
        store_wide(batch.feature + k, best.axis + splat<F>(1.0f));
        store_wide(batch.clearance + k, best.clearance);
        for (int which = 0; which < 2; ++which) {
            const uint32_t listed = near & (which == 0 ? ~by_edge : by_edge);
            store_numbers<F>(batch.list[which] + lists[which], listed, k);
            lists[which] += __builtin_popcount(listed);
        }
    }
    for (int which = 0; W > 1 && which < 2; ++which) {  // the last block is filled up with the last pair
        int32_t *const end = batch.list[which] + lists[which], last = lists[which] > 0 ? end[-1] : 0;
        for (int l = 0; l < W; ++l) end[l] = last;
    }
    face_manifolds<W>(batch, batch.list[0], lists[0]);
    edge_manifolds<W>(batch, batch.list[1], lists[1]);
}
