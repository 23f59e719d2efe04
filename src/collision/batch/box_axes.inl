// Boxes in lanes and their separating axes (Gottschalk, Lin, Manocha 1996). Part of boxes.inl.

// A face is preferred to an edge axis that separates better by less than this part of the smallest half extent, and the
// axis of the last step to any other: contacts of faces are stable, and a change of axis changes every point.
constexpr float axis_tolerance = 5e-3f;
constexpr float lowest_score = -3e38f;
// Boxes that move fast may meet at several corners of their faces before the step ends, which only a manifold of faces
// lists: they get one unless an edge axis separates better by this part of how far they can come.
constexpr float fast_tolerance = 0.25f;
// Faces that are parallel to within acos of this, 0.01 rad, meet as faces whatever axis separates best.
constexpr float parallel_faces = 0.99995f;

template <class F>
struct WideBox {
    Vec3T<F> axis[3];  // in the world
    F half[3];
};

template <int W>
LENDULET_FORCE_INLINE WideBox<Wide<float, W>> load_box(const ShapeFrame* frames, const int32_t* index) {
    using F = Wide<float, W>;
    const float* base = floats_of(frames);
    F q[4], half[4];
    gather4<W>(base, index, frame_stride, frame_rotation, q);
    gather4<W>(base, index, frame_stride, frame_half, half);
    Mat3T<F> m = rotation_matrix<F>(QuatT<F>{q[0], q[1], q[2], q[3]}, splat<F>(1.0f));
    return {{m.x, m.y, m.z}, {half[0], half[1], half[2]}};
}
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> load_arm(const ShapeFrame* frames, const int32_t* index) {
    Wide<float, W> arm[4];
    gather4<W>(floats_of(frames), index, frame_stride, frame_arm, arm);
    return {arm[0], arm[1], arm[2]};
}
// From the position of one shape to that of the other. Subtracted before they are put side by side: one transposition
// takes the place of six.
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> load_offsets(const ShapeFrame* frames, const int32_t* from,
                                                         const int32_t* to) {
    using Quad = Wide<float, 4>;
    Wide<float, W> d[4];
    transpose_quads<W>(
        [&](int i) {
            const float *a = floats_of(frames + from[i]), *b = floats_of(frames + to[i]);
            auto centre = [](const float* f) { return load_wide<Quad>(f + frame_centre); };
            auto low = [](const float* f) { return load_wide<Quad>(f + frame_low + 1); };
            auto arm = [](const float* f) { return load_wide<Quad>(f + frame_arm); };
            return between_centres(centre(a), low(a), centre(b), low(b)) + (arm(b) - arm(a));
        },
        d);
    return {d[0], d[1], d[2]};
}

template <class F>
struct BestAxis {
    F axis;       // 0..2 faces of A, 3..5 faces of B, 6 + 3 i + j edge i of A with edge j of B
    F clearance;  // largest separation of all
};

// The separation along the normal of a box's face: `along` is where the other box is on that axis, `half` the own half
// extent, and the other's axes lean towards it by the cosines `turned`. Here and below the types are those of lanes
// that are different pairs, or different axes of one pair.
template <class F, class S>
LENDULET_FORCE_INLINE F face_separation(F along, F half, const S* others, const F* turned) {
    return absolute(along) - (half + (others[0] * turned[0] + others[1] * turned[1] + others[2] * turned[2]));
}

// An edge i of A and an edge j of B. What belongs to the axes after i ends in 1 and 2, as what belongs to those after
// j.
template <class F, class S>
struct EdgePair {
    S along_1, along_2;  // where B is on the axes of A
    S half_a1, half_a2;
    F r_1, r_2;  // axis of A times axis j of B, and their sizes
    F ar_1, ar_2;
    F half_b1, half_b2;
    F ar_b1, ar_b2;  // axis i of A times axis of B
    // The separation along the cross product of the edges, times the sine between these.
    LENDULET_FORCE_INLINE F separation_times_sine() const {
        F distance = absolute(along_2 * r_1 - along_1 * r_2);
        F reach = (half_a1 * ar_2 + half_a2 * ar_1) + (half_b1 * ar_b2 + half_b2 * ar_b1);
        return distance - reach;
    }
    LENDULET_FORCE_INLINE F sine_squared() const { return r_1 * r_1 + r_2 * r_2; }
};
// Of edges nearer to parallel the faces take care.
constexpr float least_sine_squared = 1e-5f;

// Separations along the 15 axes. Nearly parallel edges have none.
template <class F>
LENDULET_FORCE_INLINE void separations(const WideBox<F>& a, const WideBox<F>& b, Vec3T<F> d, F* s, F* aligned) {
    F r[3][3], ar[3][3], turned[3][3], along_a[3];  // r[i][j] = (axis i of A) . (axis j of B); turned is ar transposed
    for (int i = 0; i < 3; ++i) {
        along_a[i] = dot(a.axis[i], d);
        for (int j = 0; j < 3; ++j) r[i][j] = dot(a.axis[i], b.axis[j]), turned[j][i] = ar[i][j] = absolute(r[i][j]);
    }
    for (int i = 0; i < 3; ++i) {
        aligned[i] = maximum(maximum(ar[i][0], ar[i][1]), ar[i][2]);
        aligned[3 + i] = maximum(maximum(ar[0][i], ar[1][i]), ar[2][i]);
    }
    for (int i = 0; i < 3; ++i) {
        s[i] = face_separation(along_a[i], a.half[i], b.half, ar[i]);
        s[3 + i] = face_separation(dot(b.axis[i], d), b.half[i], a.half, turned[i]);
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const EdgePair<F, F> e{along_a[i1], along_a[i2], a.half[i1], a.half[i2], r[i1][j],  r[i2][j],
                                   ar[i1][j],   ar[i2][j],   b.half[j1], b.half[j2], ar[i][j1], ar[i][j2]};
            F sine_squared = e.sine_squared();
            F separation = e.separation_times_sine() / square_root(maximum(sine_squared, splat<F>(1e-12f)));
            s[6 + 3 * i + j] = select(sine_squared > splat<F>(least_sine_squared), separation, splat<F>(lowest_score));
        }
    }
}

// `way`: see BoxBatch.
template <class F>
LENDULET_FORCE_INLINE BestAxis<F> best_axis(const WideBox<F>& a, const WideBox<F>& b, Vec3T<F> d, F feature, F way) {
    F s[15], aligned[6];
    separations(a, b, d, s, aligned);
    auto number = [](int k) { return splat<F>(static_cast<float>(k)); };
    F face = number(0), face_separation = s[0], edge = number(6), edge_separation = s[6], parallel = aligned[0];
    for (int k = 1; k < 6; ++k) {
        auto better = s[k] > face_separation;
        face = select(better, number(k), face);
        face_separation = select(better, s[k], face_separation);
        parallel = select(better, aligned[k], parallel);
    }
    for (int k = 7; k < 15; ++k) {
        auto better = s[k] > edge_separation;
        edge = select(better, number(k), edge);
        edge_separation = select(better, s[k], edge_separation);
    }
    F tolerance = splat<F>(axis_tolerance) * minimum(minimum(minimum(a.half[0], a.half[1]), a.half[2]),
                                                     minimum(minimum(b.half[0], b.half[1]), b.half[2]));
    auto crossing = parallel < splat<F>(parallel_faces);
    auto by_edge = crossing & (edge_separation > face_separation + maximum(tolerance, splat<F>(fast_tolerance) * way));
    F axis = select(by_edge, edge, face), separation = select(by_edge, edge_separation, face_separation);
    F remembered = splat<F>(lowest_score);
    for (int k = 0; k < 15; ++k) remembered = select(feature == number(k + 1), s[k], remembered);
    auto given_up = ((way > splat<F>(0.0f)) | !crossing) & (axis < splat<F>(6.0f)) &
                    (feature > splat<F>(6.0f));  // edges for a face
    remembered = select(given_up, splat<F>(lowest_score), remembered);
    axis = select(remembered > separation - tolerance, feature - number(1), axis);
    return {axis, maximum(face_separation, edge_separation)};
}
