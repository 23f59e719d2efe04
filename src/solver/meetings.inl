// Which contacts may meet in a substep, W at a time. Part of kernels.inl.

// The points of W contacts whose records begin with the quads `m`, lanes [at, at + W) of the block.
template <int W>
LENDULET_FORCE_INLINE void prepare_cores(MeetingBlock& block, int at, const ManifoldQuads<W, 4>& m, MeetingsOf of,
                                         Wide<float, W>& reach_a, Wide<float, W>& reach_b) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), far = splat<F>(far_separation);
    const Vec3T<F> n{m.head[0], m.head[1], m.head[2]}, offset{m.tail[4], m.tail[5], m.tail[6]};
    for (int j = 0; j < 4; ++j) {
        const F s = m.point[j][3];
        const F carried = of == MeetingsOf::impacts ? m.head[4 + j] : zero;
        auto there = (s < splat<F>(0.1f * far_separation)) & (carried <= zero);
        const Vec3T<F> ra{m.point[j][0], m.point[j][1], m.point[j][2]};
        const F half_gap = splat<F>(0.5f) * s;
        const Vec3T<F> core_a = select(there, ra - (half_gap + m.tail[0]) * n, zero_vector<F>());
        const Vec3T<F> core_b = select(there, ra - offset + (half_gap + m.tail[1]) * n, zero_vector<F>());
        store_wide(block.separation[j] + at, select(there, s, far));
        reach_a = maximum(reach_a, length(core_a));
        reach_b = maximum(reach_b, length(core_b));
        for (int k = 0; k < 3; ++k) {
            store_wide(block.core_a[j][k] + at, k == 0 ? core_a.x : k == 1 ? core_a.y : core_a.z);
            store_wide(block.core_b[j][k] + at, k == 0 ? core_b.x : k == 1 ? core_b.y : core_b.z);
        }
    }
}

// How applied forces accelerate the bodies, added to `pull`, and how turning does points at `reach`.
template <int W>
LENDULET_FORCE_INLINE Wide<float, W> pull_of(const SolverBodies& bodies, const int32_t* i, Wide<float, W> reach,
                                             Wide<float, W>& pull) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(BodyMotion) / sizeof(float);
    F spin[4], push[4];
    gather4<W>(floats_of(bodies.motion.data()), i, stride, 12, spin);
    gather4<W>(floats_of(bodies.motion.data()), i, stride, 16, push);
    const F inverse_mass = load_velocity<W>(bodies.state.data(), i).inverse_mass;
    pull = pull + select(inverse_mass > splat<F>(0.0f), length(Vec3T<F>{push[0], push[1], push[2]}), splat<F>(0.0f));
    return splat<F>(2.0f) * reach * maximum(spin[3], splat<F>(1.0f));
}

template <int W>
void prepare_meetings(MeetingBlock& block, const SolverBodies& bodies, const ContactRecord* records,
                      const MeetingContacts& contacts) {
    using F = Wide<float, W>;
    const int first = contacts.first, count = contacts.count;
    block.points = 0;
    for (int at = 0; at < meeting_lanes; at += W) {
        RecordQuads<W> record{floats_of(records), {}};
        for (int l = 0; l < W; ++l) {
            const int i = first + at + l < count ? first + at + l : first;
            const ImpactContact& c = contacts.list[i];
            const ContactRecord& r = records[c.record];
            record.index[l] = static_cast<int32_t>(c.record);
            block.a[at + l] = c.a, block.b[at + l] = c.b;
            const bool on_face = turns_with_face(r), balls = (r.flags & contact_balls) != 0;
            block.face[at + l] = on_face ? (r.follow > 0.5f ? 1.0f : -1.0f) : 0.0f;
            block.radii[at + l] = balls ? r.radius_a + r.radius_b : 0.0f;
            block.slowest[at + l] = contacts.of == MeetingsOf::impacts ? slowest_bounce(r) : 1.0f;
            if (r.point_count > block.points) block.points = r.point_count;
        }
        const ManifoldQuads<W, 4> m(record);
        F reach_a = splat<F>(0.0f), reach_b = reach_a, pull = reach_a;
        prepare_cores<W>(block, at, m, contacts.of, reach_a, reach_b);
        store_wide(block.pull_a + at, pull_of<W>(bodies, block.a + at, reach_a, pull));
        store_wide(block.pull_b + at, pull_of<W>(bodies, block.b + at, reach_b, pull));
        store_wide(block.pull + at, pull);
        const F radii = load_wide<F>(block.radii + at);
        const F scale = select(radii > splat<F>(0.0f), radii + m.point[0][3], splat<F>(1.0f));
        for (int k = 0; k < 3; ++k) store_wide(block.normal[k] + at, scale * m.head[k]);
    }
    for (int l = count - first; l < meeting_lanes; ++l)  // empty lanes
        for (auto& separation : block.separation) separation[l] = far_separation, block.radii[l] = 0.0f;
    block.ready = true;
}

// Bodies as they are in a substep.
template <class F>
struct MeetingBody {
    Vec3T<F> v, w, dp;
    QuatT<F> dq;
};
template <int W>
LENDULET_FORCE_INLINE MeetingBody<Wide<float, W>> load_meeting_body(const SolverBodies& bodies, const int32_t* i) {
    using F = Wide<float, W>;
    F p[8], q[8], s[8];
    gather8<W>(floats_of(bodies.state.data()), i, 16, 0, p);
    gather8<W>(floats_of(bodies.state.data()), i, 16, 8, q);
    gather8<W>(floats_of(bodies.start.data()), i, 8, 0, s);
    return {{s[0] + p[0], s[1] + p[1], s[2] + p[2]},
            {s[4] + p[4], s[5] + p[5], s[6] + p[6]},
            {q[0], q[1], q[2]},
            {q[4], q[5], q[6], q[7]}};
}

// As time_to_meet() in impacts.cpp, of balls whose centres are `way` apart.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> nearest_way(Vec3T<F> way, Vec3T<F> v, F radii, F h) {
    const F zero = splat<F>(0.0f);
    const F speed2 = dot(v, v), closing = zero - dot(way, v), beyond = dot(way, way) - radii * radii;
    const F discriminant = closing * closing - speed2 * beyond;
    const F root = square_root(maximum(discriminant, zero));
    const F time = minimum(select(discriminant > zero, beyond / (closing + root), closing / speed2), h);
    return way + select((closing > zero) & (beyond > zero), time, zero) * v;
}

// Bits of the lanes that may meet: by bounds that hold for every point, on how much faster it can become.
template <int W>
LENDULET_FORCE_INLINE uint32_t find_meeting_lanes(const MeetingBlock& block, int at, const SolverBodies& bodies,
                                                  const SubstepConstants& k) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), h = splat<F>(k.h);
    auto get = [&](const MeetingBlock::Lanes& x) { return load_wide<F>(x + at); };
    auto get3 = [&](const MeetingBlock::Lanes(&x)[3]) { return Vec3T<F>{get(x[0]), get(x[1]), get(x[2])}; };
    const MeetingBody<F> a = load_meeting_body<W>(bodies, block.a + at), b = load_meeting_body<W>(bodies, block.b + at);
    const Vec3T<F> n0 = get3(block.normal), v = b.v - a.v, moved = b.dp - a.dp;
    const F pull_a = get(block.pull_a), pull_b = get(block.pull_b), radii = get(block.radii);
    const F faster = h * (get(block.pull) + (pull_a * dot(a.w, a.w) + pull_b * dot(b.w, b.w)));
    const F least = splat<F>(k.bounce_speed) * get(block.slowest);
    const F unsure = splat<F>(touching_gap) + splat<F>(rounding_share) * (length(moved) + (pull_a + pull_b));
    const F face = get(block.face);
    const Vec3T<F> turned = rotate(select(face > zero, a.dq, b.dq), n0);
    const Vec3T<F> n = select(absolute(face) > zero, turned, n0);
    const F leaned = dot(n, n0);
    auto balls = radii > zero;
    const bool any_balls = mask_bits(balls) != 0;
    F most = zero;  // 1 where some point may meet
    for (int j = 0; j < block.points; ++j) {
        const Vec3T<F> core_a = get3(block.core_a[j]), core_b = get3(block.core_b[j]);
        const Vec3T<F> ra = rotate(a.dq, core_a), rb = rotate(b.dq, core_b);
        const Vec3T<F> core_v = v + (cross(b.w, rb) - cross(a.w, ra));
        const Vec3T<F> shift = moved + ((rb - core_b) - (ra - core_a));
        const F separation = get(block.separation[j]);
        F approach = faster - dot(core_v, n), gap = leaned * separation + dot(n, shift), within = h * approach;
        if (any_balls) {
            const F near = length(nearest_way(n0 + shift, core_v, radii, h)) - radii;
            gap = select(balls, near, gap);
            approach = select(balls, length(core_v) + faster, approach);
            within = select(balls, h * faster, within);
        }
        auto meets = (approach >= least) & (gap - unsure <= within) & (separation < splat<F>(0.1f * far_separation));
        most = select(meets, splat<F>(1.0f), most);
    }
    return mask_bits(most > zero);
}

template <int W>
void find_meetings(MeetingBlock& block, const SolverBodies& bodies, const SubstepConstants& k) {
    uint32_t meets = 0;
    for (int at = 0; at < meeting_lanes; at += W) meets |= find_meeting_lanes<W>(block, at, bodies, k) << at;
    block.meets = meets;
}
