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
        const auto of_dynamic = [&](F x) { return select(dynamic, x, zero); };
        const auto put = [&](auto& array, int offset, const F* values) {
            scatter8<W>(floats_of(array.data()), place, sizeof(array[0]) / sizeof(float), offset, values);
        };
        const Vec3T<F> v = body.velocity(kinematic), w = body.angular_velocity(kinematic);
        const F start[8] = {v.x, v.y, v.z, zero, w.x, w.y, w.z, zero};
        put(to.start, 0, start);
        const F at[8] = {body.x.x, body.x.y, body.x.z, zero, body.x_low.x, body.x_low.y, body.x_low.z, zero};
        put(to.place, 0, at);
        const F changes[8] = {zero, zero, zero, of_dynamic(body.inverse_mass), zero, zero, zero, zero};
        const F moved[8] = {zero, zero, zero, zero, body.turn_low.x, body.turn_low.y, body.turn_low.z, one};
        put(to.state, 0, changes);
        put(to.state, 8, moved);
        const SymMat3T<F> I = body.inverse_inertia_world();
        const F inertia[8] = {of_dynamic(I.xx),
                              of_dynamic(I.yy),
                              of_dynamic(I.zz),
                              of_dynamic(I.xy),
                              of_dynamic(I.xz),
                              of_dynamic(I.yz),
                              zero,
                              zero};
        put(to.inertia, 0, inertia);

        F change[8];
        gather4<W>(floats_of(batch.bodies.change), slot, change_floats, 0, change);
        gather4<W>(floats_of(batch.bodies.change), slot, change_floats, 2, change + 4);
        const F share = lanes(batch.share);
        const Vec3T<F> change_v = share * Vec3T<F>{change[0], change[1], change[2]};
        const Vec3T<F> change_L = share * Vec3T<F>{change[5], change[6], change[7]};
        const Vec3T<F> a = load_vector<F>(batch.acceleration, i), t = load_vector<F>(batch.torque, i);
        const F motion[32] = {body.q.x,
                              body.q.y,
                              body.q.z,
                              body.q.w,
                              of_dynamic(body.inertia.x),
                              of_dynamic(body.inertia.y),
                              of_dynamic(body.inertia.z),
                              lanes(batch.linear_loss),
                              of_dynamic(body.inverse_inertia.x),
                              of_dynamic(body.inverse_inertia.y),
                              of_dynamic(body.inverse_inertia.z),
                              lanes(batch.angular_loss),
                              of_dynamic(body.L.x),
                              of_dynamic(body.L.y),
                              of_dynamic(body.L.z),
                              select(dynamic, body.anisotropy, one),
                              a.x,
                              a.y,
                              a.z,
                              lanes(batch.free),
                              t.x,
                              t.y,
                              t.z,
                              zero,
                              of_dynamic(change_v.x),
                              of_dynamic(change_v.y),
                              of_dynamic(change_v.z),
                              zero,
                              of_dynamic(change_L.x),
                              of_dynamic(change_L.y),
                              of_dynamic(change_L.z),
                              zero};
        for (int k = 0; k < 32; k += 8) put(to.motion, k, motion + k);
    }
}
