// Where colliders are, and the boxes that hold them through the step. Part of kernels.inl.

static_assert(sizeof(Geometry) % sizeof(float) == 0 && offsetof(Geometry, rounding) == 4 &&
              offsetof(Geometry, size) == 8);

// By this share of its margin a box is wider than it need be, so that it can stay as it is while the body trembles or
// creeps: in a pile that lies, hardly any box changes. A wider one would make pairs that never touch, 1 in 30 at twice
// this.
inline constexpr float box_leeway = 0.25f;

// 1 where a side of a box is beyond that of what it holds, by at most `leeway`; infinite sides may be equal.
template <class F>
LENDULET_FORCE_INLINE F holds(F side, F held, float sign, F leeway) {
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f), beyond = splat<F>(sign) * (side - held);
    return select(side == held, one, select(beyond >= zero, select(beyond <= leeway, one, zero), zero));
}

// Half extents of a ball, a capsule or a box, turned. |R| half: sizes of the first two are those of boxes without
// width.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> turned_half(QuatT<F> rotation, Vec3T<F> half) {
    const Mat3T<F> r = rotation_matrix<F>(rotation, splat<F>(1.0f));
    return half.x * absolute(r.x) + half.y * absolute(r.y) + half.z * absolute(r.z);
}

template <int W>
void bound_colliders(BoundBatch& batch) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), two = splat<F>(2.0f);
    for (int i = 0; i < batch.count; i += W) {
        const auto lanes = [&](const float* p) { return load_wide<F>(p + i); };
        const int32_t* collider = batch.collider + i;
        const BodyLanes<W> body(batch.bodies, batch.body + i);
        const auto kinematic = lanes(batch.kinematic) > zero, fixed = lanes(batch.fixed) > zero;
        F local[7], shape[8], old[8];
        gather7<W>(floats_of(batch.local), collider, local);
        gather8<W>(floats_of(batch.geometry), collider, sizeof(Geometry) / sizeof(float), 0, shape);
        const F rounding = shape[1], radius = lanes(batch.radius);
        const Vec3T<F> size = vector_of(shape + 2);
        const QuatT<F> rotation = multiply(body.q, quaternion_of(local + 3));
        const Vec3T<F> arm = rotate(body.q, vector_of(local));
        const Vec3T<F> v = body.velocity(kinematic);
        const F turn = splat<F>(batch.dt) * length(body.angular_velocity(kinematic));

        // Of what never turns no point moves, however far out.
        const F outmost = length(arm) + radius, reach = select(fixed, zero, minimum(outmost, splat<F>(1e30f)));
        const F near = minimum(splat<F>(contact_margin), splat<F>(0.25f) * radius);
        // Where a body turns that far, points found now say nothing of where it will touch: stop_at_impacts() does.
        const F at_most = minimum(turn, two);
        const F turning = select(turn <= splat<F>(batch.most_foreseen_turn), at_most * reach, zero);
        const F frame[24] = {rotation.x, rotation.y, rotation.z, rotation.w,   body.x.x,     body.x.y,
                             body.x.z,   near,       v.x,        v.y,          v.z,          turning,
                             arm.x,      arm.y,      arm.z,      reach,        size.x,       size.y,
                             size.z,     rounding,   radius,     body.x_low.x, body.x_low.y, body.x_low.z};
        for (int k = 0; k < 24; k += 8) scatter8<W>(floats_of(batch.frames), collider, frame_stride, k, frame + k);

        // The margin between two colliders is the sum of half of each one's.
        F grow = splat<F>(0.5f) * near;
        const F leeway = select(fixed, zero, splat<F>(box_leeway) * grow);
        const Vec3T<F> sweep = splat<F>(batch.dt) * v;
        const F fall = splat<F>(0.5f * batch.dt) *
                       minimum(splat<F>(batch.fall) * absolute(lanes(batch.gravity_factor)), splat<F>(batch.most_fall));
        // A turning shape reaches no farther than its radius about the body's centre, nor than the arc it runs through.
        grow = grow + (fall + select(turn > splat<F>(0.05f), at_most * outmost, zero));
        const auto given = lanes(batch.given) > zero;
        Vec3T<F> half = turned_half(rotation, size) + Vec3T<F>{rounding, rounding, rounding};
        half = select(given, load_vector<F>(batch.given_half, i), half) + Vec3T<F>{grow, grow, grow};
        const Vec3T<F> centre = body.x + (arm + load_vector<F>(batch.given_centre, i));
        const Vec3T<F> none = zero_vector<F>();
        Vec3T<F> lower = (centre - half) + minimum(sweep, none), upper = (centre + half) + maximum(sweep, none);

        // A box that holds this one and is not much too wide stays as it is. What moves far in a step would get a new
        // one each time, and gets no leeway.
        gather8<W>(floats_of(batch.boxes), batch.box + i, sizeof(BroadBox) / sizeof(float), 0, old);
        const F spare = two * leeway;
        F stays = one - lanes(batch.unboxed);
        stays = stays * (holds(old[0], lower.x, -1.0f, spare) * holds(old[4], upper.x, 1.0f, spare));
        stays = stays * (holds(old[1], lower.y, -1.0f, spare) * holds(old[5], upper.y, 1.0f, spare));
        stays = stays * (holds(old[2], lower.z, -1.0f, spare) * holds(old[6], upper.z, 1.0f, spare));
        store_wide(batch.renewed + i, one - stays);
        const F wider = select(largest(absolute(sweep)) > leeway, zero, leeway);
        const Vec3T<F> by{wider, wider, wider};
        store_vector(batch.lower, i, lower - by);
        store_vector(batch.upper, i, upper + by);
    }
}
