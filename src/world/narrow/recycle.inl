// Pairs that have barely moved keep their manifolds. Part of kernels.inl; the bounds are derived in docs/collision.md.

// How a pair has moved since its pose was kept.
template <class F>
struct WideMotion {
    QuatT<F> turn_a, turn_b;  // rotations since then
    Vec3T<F> shift;           // of B's centre of mass relative to that of A
};

// `exactly`: with what rounding took from places.
template <int W, bool exactly>
LENDULET_FORCE_INLINE WideMotion<Wide<float, W>> motion_since(const ShapeFrame* frames, const KeptPose* poses,
                                                              const int32_t* a, const int32_t* b, const int32_t* pose,
                                                              Wide<float, W>& near, Wide<float, W>& tolerance) {
    using F = Wide<float, W>;
    constexpr int pose_stride = sizeof(KeptPose) / sizeof(float);
    F qa[4], qb[4], xa[4], xb[4], kept_a[4], kept_b[4], offset[4];
    gather4<W>(floats_of(frames), a, frame_stride, frame_rotation, qa);
    gather4<W>(floats_of(frames), b, frame_stride, frame_rotation, qb);
    gather4<W>(floats_of(frames), a, frame_stride, frame_centre, xa);
    gather4<W>(floats_of(frames), b, frame_stride, frame_centre, xb);
    gather4<W>(floats_of(poses), pose, pose_stride, 0, kept_a);
    gather4<W>(floats_of(poses), pose, pose_stride, 4, kept_b);
    gather4<W>(floats_of(poses), pose, pose_stride, 8, offset);
    near = minimum(xa[3], xb[3]);
    tolerance = offset[3];
    auto turn = [](const F* q, const F* kept) {
        return multiply(QuatT<F>{q[0], q[1], q[2], q[3]}, QuatT<F>{-kept[0], -kept[1], -kept[2], kept[3]});
    };
    Vec3T<F> between{xb[0] - xa[0], xb[1] - xa[1], xb[2] - xa[2]};
    if constexpr (exactly) {
        F la[4], lb[4];
        gather4<W>(floats_of(frames), a, frame_stride, frame_low, la);
        gather4<W>(floats_of(frames), b, frame_stride, frame_low, lb);
        between = between_centres(Vec3T<F>{xa[0], xa[1], xa[2]}, Vec3T<F>{la[1], la[2], la[3]},
                                  Vec3T<F>{xb[0], xb[1], xb[2]}, Vec3T<F>{lb[1], lb[2], lb[3]});
    }
    return {turn(qa, kept_a), turn(qb, kept_b), between - Vec3T<F>{offset[0], offset[1], offset[2]}};
}

template <class F>
LENDULET_FORCE_INLINE F vector_length(QuatT<F> q) {
    return square_root(q.x * q.x + q.y * q.y + q.z * q.z);
}

// Pairs that touch and come nearer or slide faster than this, in parts of the distance at which points are listed, are
// found anew in every step: a manifold that is kept lies as it lay, which would slow small dominoes by 2 %.
constexpr float kept_speed = 10.0f;  // 1/s

// A point at r from the centre of mass moves by at most 2 |vec dq| |r| relative to that: no point of the surfaces has
// moved relative to the other body by more than `moved`.
template <int W>
void test_motion(MotionBatch& batch) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), two = splat<F>(2.0f);
    for (int k = 0; k < batch.count; k += W) {
        for (int l = batch.count - k; l < W; ++l) {
            batch.a[k + l] = batch.a[k], batch.b[k + l] = batch.b[k], batch.pose[k + l] = batch.pose[k];
        }
        const int32_t *a = batch.a + k, *b = batch.b + k, *pose = batch.pose + k;
        F near, tolerance, va[4], vb[4], arm_a[4], arm_b[4], state[4];
        WideMotion<F> m = motion_since<W, false>(batch.frames, batch.poses, a, b, pose, near, tolerance);
        gather4<W>(floats_of(batch.frames), a, frame_stride, frame_velocity, va);
        gather4<W>(floats_of(batch.frames), b, frame_stride, frame_velocity, vb);
        gather4<W>(floats_of(batch.frames), a, frame_stride, frame_arm, arm_a);
        gather4<W>(floats_of(batch.frames), b, frame_stride, frame_arm, arm_b);
        gather4<W>(floats_of(batch.poses), pose, sizeof(KeptPose) / sizeof(float), 12, state);
        F margin = step_margin(near, va, vb, batch.dt, batch.fall);
        F moved = square_root(dot(m.shift, m.shift)) +
                  two * (vector_length(m.turn_a) * arm_a[3] + vector_length(m.turn_b) * arm_b[3]);
        const F way = margin - near - splat<F>(batch.fall), most = splat<F>(kept_speed * batch.dt) * near;
        const F touching = select(tolerance < splat<F>(any_motion), zero, tolerance);
        tolerance = select(way > most, touching, tolerance);
        F room = minimum(tolerance, state[0] - margin);
        store_wide(batch.margin + k, margin);
        store_wide(batch.kept + k, select(moved <= room, splat<F>(1.0f), splat<F>(0.0f)));
    }
}

// New separations of kept manifolds: normal and arms stay as they were found, and the surfaces' points move with their
// bodies; that of a ball or swept edge does not turn with it, only its core point does.
template <int W>
void refresh(RefreshBatch& batch) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(ContactRecord) / sizeof(float);
    const float* base = floats_of(batch.records);
    for (int k = 0; k < batch.count; k += W) {
        int32_t a[W], b[W], pose[W], record[W];
        int live = batch.count - k < W ? batch.count - k : W;
        for (int l = 0; l < W; ++l) {
            int i = k + (l < live ? l : 0);
            a[l] = batch.a[i], b[l] = batch.b[i], pose[l] = batch.pose[i], record[l] = batch.record[i];
        }
        F near, tolerance, normal[4], point[4][4], radii[4], offset[4], found[4];
        WideMotion<F> m = motion_since<W, true>(batch.frames, batch.poses, a, b, pose, near, tolerance);
        gather4<W>(base, record, stride, 0, normal);
        for (int j = 0; j < 4; ++j) gather4<W>(base, record, stride, 16 + 4 * j, point[j]);
        gather4<W>(base, record, stride, 32, radii);
        gather4<W>(base, record, stride, 36, offset);
        gather4<W>(floats_of(batch.found), record, 4, 0, found);
        Vec3T<F> n{normal[0], normal[1], normal[2]}, centres{offset[0], offset[1], offset[2]};
        Vec3T<F> lean_a = turned_back(m.turn_a, n), lean_b = turned_back(m.turn_b, n);
        F base_shift = dot(n, m.shift) + radii[1] * dot(lean_b, n) + radii[0] * dot(lean_a, n);
        for (int j = 0; j < 4; ++j) {
            Vec3T<F> ra{point[j][0], point[j][1], point[j][2]};
            point[j][3] = found[j] + (base_shift + (dot(lean_b, ra - centres) - dot(lean_a, ra)));
        }
        for (int l = 0; l < live; ++l) {
            ContactRecord& r = batch.records[record[l]];
            for (int j = 0; j < 4; ++j) r.points[j].separation = lane(point[j][3], l);
        }
    }
}
