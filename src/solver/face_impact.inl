// Points of a manifold that meet at once: a box that lands flat. Part of impacts.cpp.
//
// Taken one after the other the first corner alone would turn the body round. Newton's law for all of them at once
// (Moreau 1988) is that each leaves e times as fast as it came, or faster if it carries nothing: a linear
// complementarity problem with a rank of at most three, since in the plane of the points their velocities along the
// normal are (1 u v) g and the answers to impulses there (1 u v) K (1 u v)^T. What carries acts at one point among them,
// and an impact at that point alone is theirs.

// Points that meet at once do so within the time in which the fastest goes this part of their distance: bodies that
// give way by as much in an impact do not tell.
constexpr float flat_slope = 0.004f;

struct FacePoints {
    int count = 0;
    double at[4][3];  // 1, u, v
    double weight[4];
    double K[3][3];
    double approach[3];  // g, before the impact, m/s
};

double in_plane(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double answer(const FacePoints& f, int i, int j) {
    const double along[3] = {in_plane(f.K[0], f.at[j]), in_plane(f.K[1], f.at[j]), in_plane(f.K[2], f.at[j])};
    return in_plane(f.at[i], along);
}

// Whether the points named by the bits of `carrying`, at most three, can carry what all want of velocity: their loads.
bool try_carrying(const FacePoints& f, unsigned carrying, const double wanted[4], double most, double load[4]) {
    int points[3], n = 0;
    for (int i = 0; i < f.count; ++i) {
        load[i] = 0.0;
        if (carrying >> i & 1u) points[n++] = i;
    }
    double m[3][4];
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) m[i][j] = answer(f, points[i], points[j]);
        m[i][3] = wanted[points[i]];
    }
    for (int i = 0; i < n; ++i) {  // symmetric and positive: no pivots are sought
        if (!(m[i][i] > 1e-9 * answer(f, points[i], points[i]))) return false;
        for (int j = 0; j < n; ++j) {
            const double part = m[j][i] / m[i][i];
            for (int c = i; j != i && c < 4; ++c) m[j][c] -= part * m[i][c];
        }
    }
    for (int i = 0; i < n; ++i)
        if (!((load[points[i]] = m[i][3] / m[i][i]) >= 0.0)) return false;
    for (int i = 0; i < f.count; ++i) {
        double got = 0.0;
        for (int j = 0; j < n; ++j) got += answer(f, i, points[j]) * load[points[j]];
        if (!(got >= wanted[i] - 1e-4 * most)) return false;
    }
    return true;
}

// Finds who carries how much of an impact, as weights; `pushed` is what friction adds to g.
bool share_impact(FacePoints& f, float restitution, const double pushed[3]) {
    constexpr unsigned sets[] = {7, 11, 13, 14, 3, 5, 6, 9, 10, 12, 1, 2, 4, 8};
    double wanted[4], most = 0.0, load[4];
    for (int i = 0; i < f.count; ++i) {
        wanted[i] = -(1.0 + static_cast<double>(restitution)) * in_plane(f.at[i], f.approach) - in_plane(f.at[i], pushed);
        most = wanted[i] > most ? wanted[i] : most;
    }
    for (unsigned carrying : sets) {
        if (carrying >> f.count != 0 || !try_carrying(f, carrying, wanted, most, load)) continue;
        double sum = 0.0;
        for (int i = 0; i < f.count; ++i) sum += load[i];
        if (!(sum > 0.0)) return false;
        for (int i = 0; i < f.count; ++i) f.weight[i] = load[i] / sum;
        return true;
    }
    return false;
}

// Both bodies as they are, for points in a plane.
struct Face {
    Meeting m;  // arms of the points' middle
    Vec3 n, x, y;

    void set_answers(FacePoints& f) const {
        const SymMat3 &Ia = m.a.inverse_inertia, &Ib = m.b.inverse_inertia;
        const Vec3 ka = cross(m.a.arm, n), kb = cross(m.b.arm, n), q = Ia * ka + Ib * kb;
        const Vec3 Sx = Ia * x + Ib * x, Sy = Ia * y + Ib * y;
        f.K[0][0] = m.response(n, n);
        f.K[0][1] = f.K[1][0] = -dot(q, y), f.K[0][2] = f.K[2][0] = dot(q, x);
        f.K[1][1] = dot(y, Sy), f.K[1][2] = f.K[2][1] = -dot(x, Sy), f.K[2][2] = dot(x, Sx);
        set_motion(f.approach, m.slip(), m.b.w - m.a.w);
    }
    void set_motion(double g[3], Vec3 slip, Vec3 spin) const {
        g[0] = dot(slip, n), g[1] = -dot(spin, y), g[2] = dot(spin, x);
    }
    // What friction at a point of the plane adds to g.
    void push(const ContactRecord& r, Vec3 off, const ContactExtra* extra, double g[3]) const {
        Meeting there = m;
        there.a.arm += off, there.b.arm += off;
        const float speed = -dot(there.slip(), n);
        if (!(speed > 0.0f)) return;
        Vec3 f = impact_impulse(there, r, n, speed, extra);
        f = f - dot(f, n) * n;
        const Vec3 turn_a = -(m.a.inverse_inertia * cross(there.a.arm, f)),
                   turn_b = m.b.inverse_inertia * cross(there.b.arm, f);
        set_motion(g, m.inverse_masses * f + cross(turn_b, m.b.arm) - cross(turn_a, m.a.arm), turn_b - turn_a);
    }
};

// Whether at least two points of the manifold meet at once, and the point where their impact acts. Of `fresh` ones
// those that have carried nothing.
bool meet_at_once(Side& a, Side& b, const ContactRecord& r, bool fresh, const ContactExtra* extra,
                  const SubstepConstants& k, ContactPointRecord& where) {
    int places[4], count = 0;
    Vec3 arm_a[4], arm_b[4], middle_a, middle_b;
    float first = k.h, last = 0.0f, fastest = 0.0f;
    Face face;
    for (int j = 0; j < r.point_count; ++j) {
        if (fresh && r.normal_impulse[j] > 0.0f) continue;
        const Nearing near = nearing_of(a, b, r, r.points[j], k.h);
        if (near.first.time > k.h || !(near.first.speed > 0.0f)) continue;
        first = minimum(first, near.first.time), last = maximum(last, near.first.time);
        fastest = maximum(fastest, near.first.speed);
        face.n = near.normal;
        middle_a += a.now.core, middle_b += b.now.core;
        arm_a[count] = a.now.core, arm_b[count] = b.now.core;
        places[count++] = j;
    }
    if (count < 2 || !(fastest >= slowest_bounce(r) * k.bounce_speed)) return false;
    const float share = 1.0f / static_cast<float>(count);
    face.m.a = a.now, face.m.b = b.now;
    face.m.a.arm = share * middle_a, face.m.b.arm = share * middle_b;
    face.m.inverse_masses = a.state->inverse_mass + b.state->inverse_mass;
    face.x = perpendicular(face.n), face.y = cross(face.n, face.x);
    FacePoints f;
    f.count = count;
    float spread = 0.0f;
    for (int i = 0; i < count; ++i) {
        const Vec3 off = arm_b[i] - face.m.b.arm;
        spread = maximum(spread, length(off));
        f.at[i][0] = 1.0, f.at[i][1] = dot(off, face.x), f.at[i][2] = dot(off, face.y);
    }
    if (!((last - first) * fastest < flat_slope * spread)) return false;
    face.set_answers(f);
    // Friction tilts the body too, and where the impact acts follows from that.
    double pushed[3] = {0.0, 0.0, 0.0};
    for (int times = 0; times < 3; ++times) {
        if (!share_impact(f, r.restitution, pushed)) return false;
        if (!(r.dynamic_friction > 0.0f)) break;
        Vec3 off;
        for (int i = 0; i < count; ++i) off += static_cast<float>(f.weight[i]) * (arm_b[i] - face.m.b.arm);
        face.push(r, off, extra, pushed);
    }
    Vec3 position;
    where.separation = 0.0f;
    for (int i = 0; i < count; ++i) {
        const ContactPointRecord& p = r.points[places[i]];
        const float weight = static_cast<float>(f.weight[i]);
        position += weight * load(p.position);
        where.separation += weight * p.separation;
    }
    for (int d = 0; d < 3; ++d) where.position[d] = component(position, d);
    return true;
}
