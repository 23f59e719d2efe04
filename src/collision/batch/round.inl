// Balls and capsules as swept segments, and boxes with balls, W pairs side by side: nearest points of the cores, then
// the radii. The same closed forms as in pair_ball.cpp, branches turned into choices. Included by units that define
// LENDULET_KERNEL_SPACE.

// Core points closer than this part of the radii have no direction between them that means anything.
constexpr float coincident_cores = 1e-6f;

// Surfaces that are closer than this may touch within the step: where points are wanted, and how far both can come.
template <class F>
LENDULET_FORCE_INLINE F step_margin(F near, const F* velocity_a, const F* velocity_b, float dt, float fall) {
    Vec3T<F> speed{velocity_b[0] - velocity_a[0], velocity_b[1] - velocity_a[1], velocity_b[2] - velocity_a[2]};
    F way = splat<F>(dt) * square_root(dot(speed, speed)) + splat<F>(fall);
    return near + way + (velocity_a[3] + velocity_b[3]);
}

template <class F>
struct WideRound {
    QuatT<F> rotation;
    Vec3T<F> centre, low, arm, half;  // of the body, of the shape from there; half extents of the core
    F rounding;
    F near, velocity[4];
};

template <int W>
LENDULET_FORCE_INLINE WideRound<Wide<float, W>> load_round(const ShapeFrame* frames, const int32_t* index) {
    using F = Wide<float, W>;
    const float* base = floats_of(frames);
    WideRound<F> r;
    F q[4], x[4], arm[4], size[4], low[4];
    gather4<W>(base, index, frame_stride, frame_rotation, q);
    gather4<W>(base, index, frame_stride, frame_centre, x);
    gather4<W>(base, index, frame_stride, frame_velocity, r.velocity);
    gather4<W>(base, index, frame_stride, frame_arm, arm);
    gather4<W>(base, index, frame_stride, frame_half, size);
    gather4<W>(base, index, frame_stride, frame_low, low);
    r.rotation = {q[0], q[1], q[2], q[3]};
    r.centre = {x[0], x[1], x[2]}, r.near = x[3];
    r.low = {low[1], low[2], low[3]};
    r.arm = {arm[0], arm[1], arm[2]};
    r.half = {size[0], size[1], size[2]}, r.rounding = size[3];
    return r;
}

// From the position of one shape to that of the other.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> offset_between(const WideRound<F>& a, const WideRound<F>& b) {
    return between_centres(a.centre, a.low, b.centre, b.low) + (b.arm - a.arm);
}

// x / y, or 0 where y is not positive.
template <class F>
LENDULET_FORCE_INLINE F ratio_or_zero(F x, F y) {
    auto positive = y > splat<F>(0.0f);
    return select(positive, x / select(positive, y, splat<F>(1.0f)), splat<F>(0.0f));
}

// How bodies move against each other within the step, by which most pairs that might touch by their speed do not: what
// leaves or passes by.
template <class F>
struct WideWay {
    Vec3T<F> way;
    F near;  // what is closer than this may touch whichever way bodies go: points are wanted, and gravity and turning
    LENDULET_FORCE_INLINE WideWay(const WideRound<F>& a, const WideRound<F>& b, float dt, float fall)
        : way(splat<F>(dt) *
              Vec3T<F>{b.velocity[0] - a.velocity[0], b.velocity[1] - a.velocity[1], b.velocity[2] - a.velocity[2]}),
          near(minimum(a.near, b.near) + splat<F>(fall) + (turning_of(a) + turning_of(b))) {}
    // A ball that turns about its middle stays where it is.
    LENDULET_FORCE_INLINE static F turning_of(const WideRound<F>& r) {
        auto turns_within = dot(r.arm, r.arm) + dot(r.half, r.half) <= splat<F>(1e-10f) * r.rounding * r.rounding;
        return select(turns_within, splat<F>(0.0f), r.velocity[3]);
    }

    // Of convex shapes this far apart along a line from A to B: while they are so along it, they do not touch.
    LENDULET_FORCE_INLINE auto may_touch(Vec3T<F> normal, F separation) const {
        return separation <= near + maximum(splat<F>(0.0f), -dot(way, normal));
    }
    // Of two balls: their distance where they come nearest.
    LENDULET_FORCE_INLINE auto balls_may_touch(Vec3T<F> between, F radii) const {
        const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
        const F part = minimum(one, maximum(zero, ratio_or_zero(-dot(between, way), dot(way, way))));
        const Vec3T<F> nearest = between + part * way;
        const F reach = radii + near;
        return dot(nearest, nearest) <= reach * reach;
    }
};

// What one block of pairs gives. Positions from the shape of A, as the block has it.
template <class F>
struct RoundManifold {
    Vec3T<F> normal, position[2];
    F separation[2], follow, count, passes;
};

template <int W>
LENDULET_FORCE_INLINE void store_round(BatchManifold* out, const RoundBatch& batch, int k,
                                       const WideRound<Wide<float, W>>& a, const WideRound<Wide<float, W>>& b,
                                       const RoundManifold<Wide<float, W>>& m) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    auto swap = load_wide<F>(batch.exchanged + k) > zero;
    // From the centre of mass of the one that the caller calls A.
    Vec3T<F> offset = offset_between(a, b);
    Vec3T<F> origin = select(swap, b.arm - offset, a.arm), normal = select(swap, -m.normal, m.normal);
    F radius_a = select(swap, b.rounding, a.rounding), radius_b = select(swap, a.rounding, b.rounding);
    F follow = select(swap, one - m.follow, m.follow);
    constexpr int stride = sizeof(BatchManifold) / sizeof(float);
    int32_t place[W];
    for (int l = 0; l < W; ++l) place[l] = k + l;
    const F head[4] = {normal.x, normal.y, normal.z, follow};
    scatter4<W>(floats_of(out), place, stride, 0, head);
    for (int i = 0; i < 2; ++i) {
        Vec3T<F> p = origin + m.position[i];
        auto there = m.count > splat<F>(static_cast<float>(i));
        const F point[4] = {select(there, p.x, zero), select(there, p.y, zero), select(there, p.z, zero),
                            select(there, m.separation[i], splat<F>(absent_separation))};
        scatter4<W>(floats_of(out), place, stride, 4 + 4 * i, point);
    }
    for (int l = 0; l < W; ++l) {
        BatchManifold& to = out[k + l];
        for (int i = 2; i < 4; ++i) to.points[i] = {{0.0f, 0.0f, 0.0f}, absent_separation};
        to.id[0] = to.id[2] = to.id[3] = 0, to.id[1] = lane(m.count, l) > 1.0f ? 1 : 0;
        to.count = static_cast<int32_t>(lane(m.count, l));
        to.radius_a = lane(radius_a, l), to.radius_b = lane(radius_b, l);
        to.passes = lane(m.passes, l);
    }
}

// Lanes beyond the last repeat the first of their block.
template <int W>
LENDULET_FORCE_INLINE void fill_block(RoundBatch& batch, int k) {
    for (int l = batch.count - k; l < W; ++l)
        batch.a[k + l] = batch.a[k], batch.b[k + l] = batch.b[k], batch.exchanged[k + l] = batch.exchanged[k];
}

template <class F>
LENDULET_FORCE_INLINE F clamp_unit(F x) {
    return maximum(splat<F>(-1.0f), minimum(splat<F>(1.0f), x));
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> any_perpendicular(Vec3T<F> n) {
    const F zero = splat<F>(0.0f);
    auto along_x = absolute(n.x) > splat<F>(0.5f);
    Vec3T<F> p{select(along_x, n.y, zero), select(along_x, -n.x, n.z), select(along_x, zero, -n.y)};
    return ratio_or_zero(splat<F>(1.0f), length(p)) * p;
}

// Two segments with half axes a and b, B's centre at `offset` from A's.
template <class F>
struct SegmentPair {
    Vec3T<F> a, b, offset;
    F aa, bb, ab, ao;
    F s, t;  // parameters of the nearest points in [-1, 1] (Lumelsky 1985); of a ball's segment: 0
    LENDULET_FORCE_INLINE SegmentPair(Vec3T<F> half_a, Vec3T<F> half_b, Vec3T<F> between)
        : a(half_a), b(half_b), offset(between), aa(dot(a, a)), bb(dot(b, b)), ab(dot(a, b)), ao(dot(a, offset)) {
        const F zero = splat<F>(0.0f);
        F bo = dot(b, offset), determinant = aa * bb - ab * ab;
        auto crossed = determinant > splat<F>(1e-6f) * aa * bb;
        F first = select(crossed, clamp_unit(ratio_or_zero(ao * bb - ab * bo, determinant)), zero);
        F beyond = ratio_or_zero(first * ab - bo, bb);
        t = clamp_unit(beyond);
        s = select((t == beyond) & (bb > zero), first, clamp_unit(ratio_or_zero(t * ab + ao, aa)));
    }
};

// Two points where the segments lie along each other, as shared_stretch() finds them.
template <class F>
LENDULET_FORCE_INLINE void along_each_other(const SegmentPair<F>& p, F ra, F rb, F margin,
                                            decltype(F{} == F{}) parallel, RoundManifold<F>& m) {
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f), one = splat<F>(1.0f);
    F upright = absolute(dot(m.normal, p.a));
    auto wanted = parallel & (p.bb > zero) & (upright * upright < splat<F>(0.01f) * p.aa) & (m.count > zero);
    F inverse = ratio_or_zero(one, p.aa);
    F start = half * ((p.ao - p.ab) * inverse + one), turn = p.ab * inverse, end = start + turn;
    F lower = maximum(zero, minimum(start, end)), upper = minimum(one, maximum(start, end));
    wanted = wanted & (upper - lower > splat<F>(0.02f) * minimum(one, absolute(turn)));
    Vec3T<F> position[2];
    F separation[2];
    F back = one / select(wanted, turn, one);
    for (int i = 0; i < 2; ++i) {
        F u = i == 0 ? lower : upper, v = maximum(zero, minimum(one, (u - start) * back));
        Vec3T<F> on_a = (u + u - one) * p.a, on_b = p.offset + (v + v - one) * p.b;
        separation[i] = dot(on_b - on_a, m.normal) - ra - rb;
        position[i] = half * (on_a + on_b) + (half * (ra - rb)) * m.normal;
    }
    auto there_0 = wanted & (separation[0] <= margin), there_1 = wanted & (separation[1] <= margin);
    auto any = there_0 | there_1;
    Vec3T<F> first = select(there_0, position[0], position[1]);
    m.position[0] = select(any, first, m.position[0]);
    m.separation[0] = select(any, select(there_0, separation[0], separation[1]), m.separation[0]);
    m.position[1] = position[1], m.separation[1] = separation[1];
    m.count = select(there_0 & there_1, splat<F>(2.0f), m.count);
}

// Balls and capsules with each other.
template <int W>
void collide_segments(RoundBatch& batch, BatchManifold* out) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f), one = splat<F>(1.0f);
    for (int k = 0; k < batch.count; k += W) {
        fill_block<W>(batch, k);
        const WideRound<F> a = load_round<W>(batch.frames, batch.a + k), b = load_round<W>(batch.frames, batch.b + k);
        F margin = step_margin(minimum(a.near, b.near), a.velocity, b.velocity, batch.dt, batch.fall);
        Vec3T<F> axis_a = a.half.y * rotation_matrix<F>(a.rotation, one).y;
        Vec3T<F> axis_b = b.half.y * rotation_matrix<F>(b.rotation, one).y;
        const SegmentPair<F> p(axis_a, axis_b, offset_between(a, b));
        Vec3T<F> on_a = p.s * p.a, between = (p.offset + p.t * p.b) - on_a;
        F radii = a.rounding + b.rounding, distance = length(between);
        // Where the axes meet, out along their common perpendicular on the side of B's centre.
        Vec3T<F> across = cross(p.a, p.b);
        F area = dot(across, across);
        auto parallel = area <= splat<F>(0.01f) * p.aa * p.bb;  // within 6 degrees
        auto straight = (p.aa > zero) | (p.bb > zero);
        Vec3T<F> line = select(p.aa > zero, p.a, p.b);
        Vec3T<F> beside = any_perpendicular(ratio_or_zero(one, length(line)) * line);
        Vec3T<F> out_of = select(parallel, beside, ratio_or_zero(one, square_root(area)) * across);
        out_of = select(dot(out_of, p.offset) < zero, -out_of, out_of);
        out_of = select(straight, out_of, Vec3T<F>{zero, one, zero});
        auto apart = distance > splat<F>(coincident_cores) * radii;
        RoundManifold<F> m;
        m.normal = select(apart, (one / select(apart, distance, one)) * between, out_of);
        m.separation[0] = distance - radii;
        m.position[0] = on_a + (a.rounding + half * m.separation[0]) * m.normal;
        const WideWay<F> way(a, b, batch.dt, batch.fall);
        m.count = select(m.separation[0] <= margin, one, zero);
        m.passes = select(straight, select(way.may_touch(m.normal, m.separation[0]), zero, one),
                          select(way.balls_may_touch(p.offset, radii), zero, one));
        auto inside = (absolute(p.s) < one) & (absolute(p.t) < one) & (area > splat<F>(0.01f) * p.aa * p.bb);
        m.follow = select(inside, half, a.rounding / radii);
        m.position[1] = zero_vector<F>(), m.separation[1] = zero;
        along_each_other(p, a.rounding, b.rounding, margin, parallel, m);
        store_round<W>(out, batch, k, a, b, m);
    }
}

// Boxes, rounded or not, with balls: the box is A.
template <int W>
void collide_box_balls(RoundBatch& batch, BatchManifold* out) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f), one = splat<F>(1.0f);
    auto sign_of = [&](F s) { return select(s < zero, zero - one, one); };
    for (int k = 0; k < batch.count; k += W) {
        fill_block<W>(batch, k);
        const WideRound<F> a = load_round<W>(batch.frames, batch.a + k), b = load_round<W>(batch.frames, batch.b + k);
        F margin = step_margin(minimum(a.near, b.near), a.velocity, b.velocity, batch.dt, batch.fall);
        Mat3T<F> turn = rotation_matrix<F>(a.rotation, one);
        Vec3T<F> offset = offset_between(a, b);
        Vec3T<F> centre{dot(turn.x, offset), dot(turn.y, offset), dot(turn.z, offset)}, h = a.half;
        Vec3T<F> core{maximum(-h.x, minimum(h.x, centre.x)), maximum(-h.y, minimum(h.y, centre.y)),
                      maximum(-h.z, minimum(h.z, centre.z))};
        Vec3T<F> between = centre - core;
        F distance = length(between), radii = a.rounding + b.rounding;
        auto outside = distance > splat<F>(coincident_cores) * b.rounding;
        auto count_if = [&](F x) { return select(x == zero, zero, one); };
        F axes = count_if(between.x) + count_if(between.y) + count_if(between.z);
        auto sharp = a.rounding == zero;
        F on_edge = select(sharp, select(axes == splat<F>(2.0f), half, zero), a.rounding / radii);
        // Inside: the nearest face; ties go to the first axis, then to the positive side.
        Vec3T<F> depth{h.x - absolute(centre.x), h.y - absolute(centre.y), h.z - absolute(centre.z)};
        auto by_x = (depth.x <= depth.y) & (depth.x <= depth.z);
        auto by_y = depth.y <= depth.z;
        F least = select(by_x, depth.x, select(by_y, depth.y, depth.z));
        Vec3T<F> face{select(by_x, sign_of(centre.x), zero), select(by_x, zero, select(by_y, sign_of(centre.y), zero)),
                      select(by_x, zero, select(by_y, zero, sign_of(centre.z)))};
        Vec3T<F> direction = select(outside, (one / select(outside, distance, one)) * between, face);
        Vec3T<F> on_box = select(outside, core, centre + least * face);
        auto turned = [&](Vec3T<F> v) { return v.x * turn.x + v.y * turn.y + v.z * turn.z; };
        RoundManifold<F> m;
        m.normal = turned(direction);
        m.separation[0] = select(outside, distance, -least) - radii;
        m.position[0] = turned(on_box) + (a.rounding + half * m.separation[0]) * m.normal;
        const WideWay<F> way(a, b, batch.dt, batch.fall);
        m.count = select(m.separation[0] <= margin, one, zero);
        m.passes = select(way.may_touch(m.normal, m.separation[0]), zero, one);
        m.follow = select(outside, select(axes == one, one, on_edge), one);
        m.position[1] = zero_vector<F>(), m.separation[1] = zero;
        store_round<W>(out, batch, k, a, b, m);
    }
}
