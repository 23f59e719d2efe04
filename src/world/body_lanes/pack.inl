// Bodies into the solver's arrays. Part of kernels.inl.

template <int W>
void pack_lanes(PackBatch& batch) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    SolverBodies& to = *batch.packed;
    for (int i = 0; i < batch.count; i += W) {
        const auto lanes = [&](const float* p) { return load_wide<F>(p + i); };
        const int32_t *slot = batch.body + i, *place = batch.place + i;
        const BodyLanes<W> body(batch.bodies, slot);
        const auto dynamic = lanes(batch.dynamic) > zero, kinematic = lanes(batch.dynamic) <= zero;
        const auto put = [&](auto& array, int offset, const F* values) {
            scatter8<W>(floats_of(array.data()), place, sizeof(array[0]) / sizeof(float), offset, values);
        };
        const Vec3T<F> v = body.velocity(kinematic), w = body.angular_velocity(kinematic);
        const F start[8] = {v.x, v.y, v.z, zero, w.x, w.y, w.z, zero};
        put(to.start, 0, start);
        const F at[8] = {body.x.x, body.x.y, body.x.z, zero, body.x_low.x, body.x_low.y, body.x_low.z, zero};
        put(to.place, 0, at);
        const F changes[8] = {zero, zero, zero, select(dynamic, body.inverse_mass, zero), zero, zero, zero, zero};
        const F moved[8] = {zero, zero, zero, zero, body.turn_low.x, body.turn_low.y, body.turn_low.z, one};
        put(to.state, 0, changes);
        put(to.state, 8, moved);
        const SymMat3T<F> I = body.inverse_inertia_world();
        const Vec3T<F> none = zero_vector<F>();
        const Vec3T<F> d = select(dynamic, Vec3T<F>{I.xx, I.yy, I.zz}, none);
        const Vec3T<F> o = select(dynamic, Vec3T<F>{I.xy, I.xz, I.yz}, none);
        const F tensor[8] = {d.x, d.y, d.z, o.x, o.y, o.z, zero, zero};
        put(to.inertia, 0, tensor);

        F change[8];
        gather4<W>(floats_of(batch.bodies.change), slot, change_floats, 0, change);
        gather4<W>(floats_of(batch.bodies.change), slot, change_floats, 2, change + 4);
        const F share = lanes(batch.share), anisotropy = select(dynamic, body.anisotropy, one);
        const Vec3T<F> change_v = select(dynamic, share * Vec3T<F>{change[0], change[1], change[2]}, none);
        const Vec3T<F> change_L = select(dynamic, share * Vec3T<F>{change[5], change[6], change[7]}, none);
        const Vec3T<F> inertia = select(dynamic, body.inertia, none), L = select(dynamic, body.L, none);
        const Vec3T<F> inverse = select(dynamic, body.inverse_inertia, none);
        const Vec3T<F> a = load_vector<F>(batch.acceleration, i), t = load_vector<F>(batch.torque, i);
        const QuatT<F> q = body.q;
        const F linear_loss = lanes(batch.linear_loss), angular_loss = lanes(batch.angular_loss);
        const F free = lanes(batch.free);
        const F turned[8] = {q.x, q.y, q.z, q.w, inertia.x, inertia.y, inertia.z, linear_loss};
        const F turning[8] = {inverse.x, inverse.y, inverse.z, angular_loss, L.x, L.y, L.z, anisotropy};
        const F pushed[8] = {a.x, a.y, a.z, free, t.x, t.y, t.z, zero};
        const F changed[8] = {change_v.x, change_v.y, change_v.z, zero, change_L.x, change_L.y, change_L.z, zero};
        put(to.motion, 0, turned);
        put(to.motion, 8, turning);
        put(to.motion, 16, pushed);
        put(to.motion, 24, changed);
    }
}
