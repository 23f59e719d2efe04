// Points of two bodies that meet at once: a box that lands flat, a table on its four legs. Part of impacts.cpp.
//
// Taken one after the other the first corner alone would turn the body round. Newton's law for all of them at once
// (Moreau 1988) is that each leaves e times as fast as it came, or faster if it carries nothing: a linear
// complementarity problem with a rank of at most three, since in the plane of the points their velocities along the
// normal are (1 u v) g and the answers to impulses there (1 u v) K (1 u v)^T. What carries acts at one point among
// them, and an impact at that point alone is theirs.

// Points that meet at once do so within the time in which the fastest goes this part of their distance: bodies that
// give way by as much in an impact do not tell.
constexpr float flat_slope = 0.004f;

constexpr int most_met = 32, most_carrying = 8;

struct FacePoints {
    int count = 0;
    double at[most_carrying][3];  // 1, u, v
    double weight[most_carrying];
    double K[3][3];
    double approach[3];                            // g, before the impact, m/s
    double answers[most_carrying][most_carrying];  // of the velocity at one to an impulse at another
};

double in_plane(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Whether `n` points, at most three, can carry what all want of velocity: their loads.
bool try_carrying(const FacePoints& f, const int points[3], int n, const double wanted[most_carrying], double most,
                  double load[3]) {
    double m[3][4];
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) m[i][j] = f.answers[points[i]][points[j]];
        m[i][3] = wanted[points[i]];
    }
    for (int i = 0; i < n; ++i) {  // symmetric and positive: no pivots are sought
        if (!(m[i][i] > 1e-9 * f.answers[points[i]][points[i]])) return false;
        for (int j = 0; j < n; ++j) {
            const double part = m[j][i] / m[i][i];
            for (int c = i; j != i && c < 4; ++c) m[j][c] -= part * m[i][c];
        }
    }
    for (int i = 0; i < n; ++i)
        if (!((load[i] = m[i][3] / m[i][i]) >= 0.0)) return false;
    for (int i = 0; i < f.count; ++i) {
        double got = 0.0;
        for (int j = 0; j < n; ++j) got += f.answers[i][points[j]] * load[j];
        if (!(got >= wanted[i] - 1e-4 * most)) return false;
    }
    return true;
}

// Finds who carries how much of an impact, as weights; `pushed` is what friction adds to g.
bool share_impact(FacePoints& f, float restitution, const double pushed[3]) {
    double wanted[most_carrying], most = 0.0, load[3];
    for (int i = 0; i < f.count; ++i) {
        wanted[i] =
            -(1.0 + static_cast<double>(restitution)) * in_plane(f.at[i], f.approach) - in_plane(f.at[i], pushed);
        most = wanted[i] > most ? wanted[i] : most;
        f.weight[i] = 0.0;
    }
    auto found = [&](const int points[3], int n) {
        if (!try_carrying(f, points, n, wanted, most, load)) return false;
        double sum = 0.0;
        for (int i = 0; i < n; ++i) sum += load[i];
        for (int i = 0; i < n && sum > 0.0; ++i) f.weight[points[i]] = load[i] / sum;
        return sum > 0.0;
    };
    for (int n = f.count < 3 ? f.count : 3; n > 0; --n) {
        int points[3] = {0, 1, 2};
        for (;;) {
            if (found(points, n)) return true;
            int last = n - 1;  // the next set of n, in order
            while (last >= 0 && points[last] == f.count - n + last) --last;
            if (last < 0) break;
            ++points[last];
            for (int i = last + 1; i < n; ++i) points[i] = points[i - 1] + 1;
        }
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
        for (int j = 0; j < f.count; ++j) {
            const double* at = f.at[j];
            const double along[3] = {in_plane(f.K[0], at), in_plane(f.K[1], at), in_plane(f.K[2], at)};
            for (int i = 0; i < f.count; ++i) f.answers[i][j] = in_plane(f.at[i], along);
        }
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

// Points that meet in this substep, of all contacts between two bodies.
struct MetPoints {
    int count = 0;
    float time[most_met], speed[most_met], separation[most_met];
    Vec3 arm_a[most_met], arm_b[most_met];
    Vec3 start[most_met];  // from B, when the step began

    void add(Side& a, Side& b, const ContactRecord& r, bool fresh, float h) {
        for (int j = 0; j < r.point_count && count < most_met; ++j) {
            if (fresh && r.normal_impulse[j] > 0.0f) continue;
            const Nearing near = nearing_of(a, b, r, r.points[j], h);
            if (near.first.time > h || !(near.first.speed > 0.0f)) continue;
            time[count] = near.first.time, speed[count] = near.first.speed;
            separation[count] = r.points[j].separation;
            arm_a[count] = a.now.core, arm_b[count] = b.now.core;
            start[count++] = load(r.points[j].position) - load(r.arm_offset);
        }
    }
    void keep(int i, int of) {
        time[i] = time[of], speed[i] = speed[of], separation[i] = separation[of];
        arm_a[i] = arm_a[of], arm_b[i] = arm_b[of], start[i] = start[of];
    }
    float fastest() const {
        float most = 0.0f;
        for (int i = 0; i < count; ++i) most = maximum(most, speed[i]);
        return most;
    }
    // Drops what meets later than the first, and of more than a few what does not lie at the rim.
    void keep_first() {
        float first = time[0], spread = 0.0f;
        for (int i = 0; i < count; ++i) {
            first = minimum(first, time[i]);
            spread = maximum(spread, length(arm_b[i] - arm_b[0]));
        }
        const float most = flat_slope * spread / fastest();
        int kept = 0;
        for (int i = 0; i < count; ++i)
            if (time[i] - first <= most) keep(kept++, i);
        count = kept;
    }
    void keep_rim(Vec3 x, Vec3 y) {
        if (count <= most_carrying) return;
        constexpr float sides[most_carrying][2] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                                   {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        bool at_rim[most_met] = {};
        for (const auto& side : sides) {
            const Vec3 out = side[0] * x + side[1] * y;
            int farthest = 0;
            for (int i = 1; i < count; ++i)
                if (dot(out, arm_b[i]) > dot(out, arm_b[farthest])) farthest = i;
            at_rim[farthest] = true;
        }
        int kept = 0;
        for (int i = 0; i < count; ++i)
            if (at_rim[i]) keep(kept++, i);
        count = kept;
    }
};

bool meet_alike(const ContactRecord& r, const ContactRecord& s) {
    constexpr float level = 1.0f - 1e-6f;
    return ((r.flags | s.flags) & contact_balls) == 0 && r.restitution == s.restitution && r.radius_a == s.radius_a &&
           r.radius_b == s.radius_b && r.follow == s.follow && dot(load(r.normal), load(s.normal)) >= level;
}

enum class Meet { none, one_by_one, at_once };

// How the points of a contact meet, with those of contacts between the same bodies that follow it; where at least two
// do at once, the point where their impact acts, as one of the contact's own. Of `fresh` ones those that have carried
// nothing.
Meet how_they_meet(Side& a, Side& b, const ContactRecord* records, const ImpactList& list, const ImpactContact& c,
                   bool fresh, const SubstepConstants& k, ContactPointRecord& where) {
    const ContactRecord& r = records[c.record];
    if (r.point_count < 2 && c.next < 0) return Meet::one_by_one;
    MetPoints met;
    met.add(a, b, r, fresh, k.h);
    if (!(met.fastest() >= slowest_bounce(r) * k.bounce_speed)) return Meet::none;
    for (int i = c.next; i >= 0; i = list.contacts[i].next) {
        const ImpactContact& other = list.contacts[i];
        if (!(fresh && other.held) && meet_alike(r, records[other.record]))
            met.add(a, b, records[other.record], fresh, k.h);
    }
    met.keep_first();
    if (met.count < 2) return Meet::one_by_one;
    Face face;
    face.n = turns_with_face(r) ? rotate((r.follow > 0.5f ? a : b).now.dq, load(r.normal)) : load(r.normal);
    face.x = perpendicular(face.n), face.y = cross(face.n, face.x);
    met.keep_rim(face.x, face.y);
    Vec3 middle_a, middle_b;
    const float part = 1.0f / static_cast<float>(met.count);
    for (int i = 0; i < met.count; ++i) middle_a += part * met.arm_a[i], middle_b += part * met.arm_b[i];
    face.m.a = a.now, face.m.b = b.now;
    face.m.a.arm = middle_a, face.m.b.arm = middle_b;
    face.m.inverse_masses = a.state->inverse_mass + b.state->inverse_mass;
    FacePoints f;
    f.count = met.count;
    for (int i = 0; i < f.count; ++i) {
        const Vec3 off = met.arm_b[i] - middle_b;
        f.at[i][0] = 1.0, f.at[i][1] = dot(off, face.x), f.at[i][2] = dot(off, face.y);
    }
    face.set_answers(f);
    // Friction tilts the body too, and where the impact acts follows from that.
    double pushed[3] = {0.0, 0.0, 0.0};
    const ContactExtra* extra = list.extras ? list.extras + c.record : nullptr;
    const auto fastest = static_cast<double>(met.fastest());
    for (int times = 0; times < 3; ++times) {
        if (!share_impact(f, r.restitution, pushed)) return Meet::one_by_one;
        if (!(r.dynamic_friction > 0.0f) || times == 2) break;
        Vec3 off;
        for (int i = 0; i < f.count; ++i) off += static_cast<float>(f.weight[i]) * (met.arm_b[i] - middle_b);
        face.push(r, off, extra, pushed);
        double most = 0.0;  // at any of the points
        for (int i = 0; i < f.count; ++i) {
            const double there = in_plane(f.at[i], pushed);
            most = there * there > most ? there * there : most;
        }
        if (!(most > 1e-8 * fastest * fastest)) break;
    }
    Vec3 position = load(r.arm_offset);
    where.separation = 0.0f;
    for (int i = 0; i < f.count; ++i) {
        const float weight = static_cast<float>(f.weight[i]);
        position += weight * met.start[i];
        where.separation += weight * met.separation[i];
    }
    for (int d = 0; d < 3; ++d) where.position[d] = component(position, d);
    return Meet::at_once;
}
