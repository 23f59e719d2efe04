// Rows of six-degree joints from their second records, and back. Part of kernels.inl.

template <int W>
LENDULET_FORCE_INLINE const JointAxesRecord& axes_of(const JointGroup& g, const JointRecord* records, int32_t index) {
    return g.axes[records[index].axes];
}

template <int W>
void load_six_rows(SixRow<W>& c, const JointGroup& g, const JointRecord* records, const int32_t* index,
                   const int32_t (&live)[W]) {
    using F = Wide<float, W>;
    auto flag = [](uint8_t bits, int i) { return (bits >> i & 1) != 0 ? 1.0f : 0.0f; };
    c.used = 0;
    for (int l = 0; l < W; ++l) {
        const JointAxesRecord& r = axes_of<W>(g, records, index[l]);
        if (live[l]) c.used |= r.used;
        for (int i = 0; i < 6; ++i) set_lane(c.locked[i], l, live[l] ? flag(r.locked, i) : 0.0f);
        for (int i = 0; i < 3; ++i) {
            const SinCos turn = sin_cos(0.5f * r.held_at[3 + i]);
            set_lane(c.held_at[i], l, r.held_at[i]);
            set_lane(c.cosine[i], l, turn.cos);
            set_lane(c.sine[i], l, turn.sin);
            set_lane(c.distance_axes[i], l, flag(r.distance_axes, i));
            set_lane(c.swing_axes[i], l, flag(r.swing_axes, i));
        }
        for (int j = 0; j < joint_axes; ++j) {
            const JointAxisRecord& from = r.axis[j];
            auto& to = c.row[j];
            set_lane(to.used, l, live[l] ? flag(r.used, j) : 0.0f);
            set_lane(to.lower, l, from.lower), set_lane(to.upper, l, from.upper);
            set_lane(to.limit_stiffness, l, from.limit_stiffness), set_lane(to.limit_damping, l, from.limit_damping);
            set_lane(to.motor_velocity, l, from.motor_velocity), set_lane(to.motor_force, l, from.motor_force);
            set_lane(to.stiffness, l, from.stiffness), set_lane(to.damping, l, from.damping);
            set_lane(to.target, l, from.target), set_lane(to.target_velocity, l, from.target_velocity);
            set_lane(to.spring_force, l, from.spring_force);
        }
    }
    const F zero = splat<F>(0.0f);
    for (auto& row : c.row) row.spring_sum = zero;
}

template <int W>
void load_six_impulses(SixRow<W>& c, const JointGroup& g, const JointRecord* records, const int32_t* index,
                       Wide<float, W> scale) {
    for (int l = 0; l < W; ++l) {
        const JointAxesRecord& r = axes_of<W>(g, records, index[l]);
        const float s = lane(scale, l);
        for (int j = 0; j < joint_axes; ++j) {
            set_lane(c.row[j].limit, l, s * r.axis[j].limit);
            set_lane(c.row[j].motor, l, s * r.axis[j].motor);
            set_lane(c.row[j].spring, l, s * r.axis[j].spring);
        }
    }
}

template <int W>
void store_six(const SixRow<W>& c, const JointGroup& g, const JointRecord* records, int first) {
    for (int l = 0; l < W && first + l < g.count; ++l) {
        JointAxesRecord& r = g.axes[records[g.order[first + l]].axes];
        for (int j = 0; j < joint_axes; ++j) {
            r.axis[j].limit = lane(c.row[j].limit, l);
            r.axis[j].motor = lane(c.row[j].motor, l);
            r.axis[j].spring = lane(c.row[j].spring, l);
        }
    }
}
