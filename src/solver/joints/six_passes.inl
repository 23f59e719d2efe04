// The bounded rows of six-degree joints, one after the other with the locked rows held. Part of kernels.inl.
//
// A row has a spring, a motor and bounds, and its bounds are hard or springs themselves. Lanes that do not use a row
// stay as they are, so that what a joint does never depends on its neighbours.

template <int W>
struct AxisResponse {
    using F = Wide<float, W>;
    F back[6];  // impulses of the locked rows that hold them still, per unit of this row's
    F rate;     // velocity per unit impulse
};

constexpr bool is_linear_row(int j) { return j < 3 || j == distance_row; }

template <int W>
LENDULET_FORCE_INLINE AxisResponse<W> answer_of(int j, const SixRow<W>& c, const SixGeometry<W>& o,
                                                const PointResponse<Wide<float, W>>& p,
                                                const Factor<Wide<float, W>, 6>& mass) {
    using F = Wide<float, W>;
    Vec3T<F> u = o.direction[j], slide, turn;
    if (is_linear_row(j)) slide = p.linear * u, turn = p.turned(u);
    else slide = p.coupled(u), turn = p.angular * u;
    AxisResponse<W> r;
    F b[6];
    for (int i = 0; i < 6; ++i) {
        b[i] = c.locked[i] * dot(o.direction[i], i < 3 ? slide : turn);
        r.back[i] = b[i];
    }
    mass.solve(r.back);
    F own = dot(u, is_linear_row(j) ? slide : turn), rest = own;
    for (int i = 0; i < 6; ++i) rest = rest - b[i] * r.back[i];
    r.rate = maximum(rest, splat<F>(1e-6f) * own);
    return r;
}

// Spring of the coordinate and of a bound that gives way, both by the implicit midpoint rule as in solve_drive(): with
// s = h (damping + h stiffness / 2) and f = h (stiffness (x - target) - damping target_velocity) the impulse of either
// is
// -(s v + f) with v the velocity after it. The first one has a greatest force; the bound only pushes inward.
template <int W, class Row>
LENDULET_FORCE_INLINE Wide<float, W> spring_impulse(const Row& row, Wide<float, W> x, float h, float step,
                                                    Wide<float, W> rate, Wide<float, W> without) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), H = splat<F>(h), half = splat<F>(0.5f * step);
    F soft = H * (row.damping + half * row.stiffness), most = H * row.spring_force;
    F force = H * (row.stiffness * (x - row.target) - row.damping * row.target_velocity);
    auto cut = [&](F impulse) { return maximum(minimum(impulse, most), zero - most); };
    F alone = cut((zero - (soft * without + force)) / (soft * rate + one));
    F below = row.lower - x, above = row.upper - x;
    auto under = below > zero, over = above < zero;
    decltype(below > zero) gives = (row.limit_stiffness > zero) & (under | over);
    if (mask_bits(gives) == 0) return alone;
    F limit_soft = H * (row.limit_damping + half * row.limit_stiffness);
    F limit_force = H * row.limit_stiffness * (zero - select(under, below, above));
    F both = (zero - ((soft + limit_soft) * without + (force + limit_force))) / ((soft + limit_soft) * rate + one);
    F own = zero - (soft * (without + rate * both) + force), kept = cut(own);
    both = select((kept < own) | (kept > own),
                  (kept - (limit_soft * without + limit_force)) / (limit_soft * rate + one), both);
    F push = both - kept;
    auto inward = (under & (push > zero)) | (over & (push < zero));
    return select(gives & inward, both, alone);
}

template <int W, bool biased, class Row>
LENDULET_FORCE_INLINE Wide<float, W> solve_springs(Row& row, const JointConstants& k, bool split, Wide<float, W> share,
                                                   Wide<float, W> rate, Wide<float, W> x, Wide<float, W> v) {
    using F = Wide<float, W>;
    if (!biased && !split) return splat<F>(0.0f);
    F known = split && !k.first ? row.spring : splat<F>(0.0f), sum = known;  // what the last drift's still has to give
    if constexpr (biased) {
        F without = v + rate * (known - row.spring_sum);
        F next = spring_impulse<W>(row, x, split ? 0.5f * k.h : k.h, k.h, rate, without);
        sum = row.spring_sum + share * ((known + next) - row.spring_sum);
        row.spring = sum - known;
    }
    F change = sum - row.spring_sum;
    row.spring_sum = sum;
    return change;
}

template <int W, class Row>
LENDULET_FORCE_INLINE Wide<float, W> solve_motor(Row& row, const JointConstants& k, bool split, Wide<float, W> share,
                                                 Wide<float, W> rate, Wide<float, W> v) {
    using F = Wide<float, W>;
    F most = splat<F>(split ? k.share * k.h : k.h) * row.motor_force;
    F wanted = row.motor + inverse_or_zero(rate) * (row.motor_velocity - v);
    F turn = share * (maximum(minimum(wanted, most), splat<F>(0.0f) - most) - row.motor);
    row.motor = row.motor + turn;
    return turn;
}

// How far the mean of the coordinate's rate over the drift is ahead of it by the motion itself: bounds are to be met at
// the end of the drift, as locked rows are, and a motor is to get as far as it was told. A distance also grows by what
// moves across it.
template <int W>
LENDULET_FORCE_INLINE Wide<float, W> axis_curvature(int j, const SixRow<W>& c, const SixGeometry<W>& o,
                                                    const JointPair<Wide<float, W>>& p, const JointConstants& k,
                                                    Vec3T<Wide<float, W>> sliding) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f);
    Vec3T<F> u = o.direction[j];
    F curvature;
    if (is_linear_row(j)) {
        curvature = dot(u, sliding_curvature(p, o.ra, o.rb, sliding));
        if (j == distance_row) {
            Vec3T<F> moving{dot(o.direction[0], sliding), dot(o.direction[1], sliding), dot(o.direction[2], sliding)};
            moving = along_flags(c.distance_axes, moving);
            F along = dot(u, sliding), across = maximum(dot(moving, moving) - along * along, zero);
            curvature = curvature + across / maximum(o.coordinate[j], splat<F>(1e-6f));
        }
    } else {
        curvature = dot(u, turning_curvature(p));
    }
    return rate_ahead(curvature, k);
}

// One row: what its impulse changes.
template <int W, bool biased>
LENDULET_FORCE_INLINE Wide<float, W> solve_axis(int j, SixRow<W>& c, const SixGeometry<W>& o, Wide<float, W> rate,
                                                const JointPair<Wide<float, W>>& p, const JointConstants& k,
                                                bool split) {
    using F = Wide<float, W>;
    auto& row = c.row[j];
    const F zero = splat<F>(0.0f);
    Vec3T<F> sliding = p.sliding(o.ra, o.rb);
    F v = dot(o.direction[j], is_linear_row(j) ? sliding : p.turning());
    if constexpr (biased) v = v + axis_curvature<W>(j, c, o, p, k, sliding);
    F change = solve_springs<W, biased>(row, k, split, c.relaxation, rate, o.coordinate[j], v);
    change = change + solve_motor<W>(row, k, split, c.relaxation, rate, v + rate * change);
    const F coordinate = j < 3 || j >= distance_row ? o.coordinate[j] : near_bounds(row, o.coordinate[j]);
    SpeedRange<F> range = speed_range<biased>(row, coordinate, bias_of(c, k, split), k);
    F held = row.limit;
    F pushed = solve_limit<biased>(row, range, rate, c.leak, c.relaxation, v + rate * change);
    auto hard = row.limit_stiffness <= zero;
    row.limit = select(hard, row.limit, held);
    change = change + select(hard, pushed, zero);
    auto used = (row.used > zero) & (rate > zero);
    // A row without a direction holds nothing.
    row.limit = select(used, row.limit, zero);
    row.motor = select(used, row.motor, zero);
    row.spring = select(used, row.spring, zero);
    row.spring_sum = select(used, row.spring_sum, zero);
    return select(used, change, zero);
}

template <int W, bool biased>
LENDULET_FORCE_INLINE void solve_axes(SixRow<W>& c, const SixGeometry<W>& o,
                                      const PointResponse<Wide<float, W>>& response,
                                      const Factor<Wide<float, W>, 6>& mass, JointPair<Wide<float, W>>& p,
                                      const JointConstants& k, bool split, JointChange<W, JointClass::six_degrees>& x) {
    using F = Wide<float, W>;
    for (int j = 0; j < joint_axes; ++j) {
        if ((c.used >> j & 1) == 0) continue;
        AxisResponse<W> r = answer_of<W>(j, c, o, response, mass);
        F change = solve_axis<W, biased>(j, c, o, r.rate, p, k, split);
        JointChange<W, JointClass::six_degrees> more;
        for (F& b : more.bounded) b = splat<F>(0.0f);
        for (int i = 0; i < 6; ++i) {
            more.locked[i] = splat<F>(0.0f) - r.back[i] * change;
            c.impulse[i] = c.impulse[i] + more.locked[i];
            x.locked[i] = x.locked[i] + more.locked[i];
        }
        more.bounded[j] = change;
        x.bounded[j] = x.bounded[j] + change;
        Vec3T<F> linear, angular;
        six_vectors<W>(o, more.locked, more.bounded, linear, angular);
        JointPair<F> pushed = p;
        pushed.push(o.ra, o.rb, linear, angular);
        auto used = c.row[j].used > splat<F>(0.0f);
        p.A.v = select(used, pushed.A.v, p.A.v), p.A.w = select(used, pushed.A.w, p.A.w);
        p.B.v = select(used, pushed.B.v, p.B.v), p.B.w = select(used, pushed.B.w, p.B.w);
    }
}
