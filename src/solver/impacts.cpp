#include "solver/impacts.h"

#include "solver/nearing.h"

namespace lendulet {
namespace {

constexpr int max_sweeps = 8, crowd_sweeps = 2;

// Both bodies at the moment of the impact.
struct Meeting {
    Moment a, b;
    float inverse_masses;
    ImpactJoints* joints = nullptr;  // where a body has any

    Vec3 slip() const { return (b.v + cross(b.w, b.arm)) - (a.v + cross(a.w, a.arm)); }
    // T^-1, thesis 3.3.2: how much the relative velocity along u changes per unit impulse along w.
    float response(Vec3 u, Vec3 w) const {
        const float free = inverse_masses * dot(u, w) + dot(cross(a.arm, u), a.inverse_inertia * cross(a.arm, w)) +
                           dot(cross(b.arm, u), b.inverse_inertia * cross(b.arm, w));
        return joints ? free - joints->held_back(a.arm, b.arm, u, w) : free;
    }
};

struct Along {
    float x, y;
};
// The unit vector along which friction acts on what slides on after an impact: against the slip that is left, which
// makes it (1 + s M) f' = f as for rows (round_limit.inl), with f the impulse that would stop the slip and M the
// inverse of `K` (11 12 22), the response of the slip where the normal impulse follows suit. Here the limit falls with
// f', as most - a f'x - b f'y, so s is found by false position, as x = s / (1 + s) in units in which M has the trace 1.
Along sliding_direction(const float K[3], float fx, float fy, float most, float a, float b) {
    // M over its trace is the adjugate of K over its trace.
    const float share = 1.0f / maximum(K[0] + K[2], 1e-30f);
    const float m11 = share * K[2], m12 = -share * K[1], m22 = share * K[0];
    Along f{fx, fy};
    auto beyond = [&](float x) {
        const float rest = 1.0f - x, d11 = rest + x * m11, d12 = x * m12, d22 = rest + x * m22;
        const float scale = rest / maximum(d11 * d22 - d12 * d12, 1e-30f);
        f = {scale * (d22 * fx - d12 * fy), scale * (d11 * fy - d12 * fx)};
        return square_root(f.x * f.x + f.y * f.y) - (most - a * f.x - b * f.y);
    };
    float low = 0.0f, high = 1.0f - 1e-6f, above = beyond(low), below = beyond(high);
    if (above > 0.0f && below < 0.0f) {
        int side = 0;
        for (int i = 0; i < 12; ++i) {
            const float x = (low * below - high * above) / (below - above), y = beyond(x);
            if (!(absolute(y) > 1e-5f * most)) break;
            // The end that stays counts half, or it would stay for ever (the Illinois rule).
            if (y > 0.0f) {
                low = x, above = y;
                if (side == 1) below *= 0.5f;
                side = 1;
            } else {
                high = x, below = y;
                if (side == -1) above *= 0.5f;
                side = -1;
            }
        }
    }
    const float size = maximum(square_root(f.x * f.x + f.y * f.y), 1e-30f);
    return {f.x / size, f.y / size};
}

// The impulse on B: Newton's restitution along n, and against the slip Coulomb's friction on the whole normal impulse
// (thesis 3.3.4, magnitudes as in THESIS-NOTES). All three components at once, since bodies other than balls answer to
// an impulse along n across it too. Newton's law alone would then let some impacts gain energy (Kane, Levinson,
// "Dynamics", 1985, 5.8): such ones get as much of the impulse as leaves it unchanged. Where a surface runs that is
// energy as seen from it.
Vec3 impact_impulse(const Meeting& m, const ContactRecord& r, Vec3 n, float speed, const ContactExtra* extra) {
    const float tangential_restitution = extra ? extra->tangential_restitution : 0.0f;
    const Vec3 running = extra ? load(extra->running) : Vec3{};
    const Vec3 x = perpendicular(n), y = cross(n, x), slip = m.slip() + (running - dot(running, n) * n);
    const float nn = m.response(n, n), nx = m.response(n, x), ny = m.response(n, y);
    const float xx = m.response(x, x), xy = m.response(x, y), yy = m.response(y, y);
    const float rise = (1.0f + r.restitution) * speed;
    const Vec3 smooth = (rise / nn) * n;
    const float sx = -(1.0f + tangential_restitution) * dot(slip, x),
                sy = -(1.0f + tangential_restitution) * dot(slip, y);
    // What gives B just these changes of velocity, if friction holds.
    const float c = xx * yy - xy * xy, cx = ny * xy - nx * yy, cy = nx * xy - ny * xx;
    const float determinant = nn * c + nx * cx + ny * cy;
    if (!(determinant > 0.0f)) return smooth;
    const float scale = 1.0f / determinant;
    float pressed = scale * (c * rise + cx * sx + cy * sy);
    float fx = scale * (cx * rise + (nn * yy - ny * ny) * sx + (nx * ny - nn * xy) * sy);
    float fy = scale * (cy * rise + (nx * ny - nn * xy) * sx + (nn * xx - nx * nx) * sy);
    if (!(square_root(fx * fx + fy * fy) <= r.static_friction * pressed)) {
        const float K[3] = {xx - nx * nx / nn, xy - nx * ny / nn, yy - ny * ny / nn};
        const float push = r.dynamic_friction / nn;
        const Along along = sliding_direction(K, fx, fy, push * rise, push * nx, push * ny);
        const float answer = nn + r.dynamic_friction * (nx * along.x + ny * along.y);
        if (!(answer > 0.1f * nn)) return smooth;
        pressed = rise / answer;
        fx = r.dynamic_friction * pressed * along.x, fy = r.dynamic_friction * pressed * along.y;
    }
    const Vec3 impulse = pressed * n + (fx * x + fy * y);
    const float work = dot(impulse, slip), effort = pressed * (nn * pressed + 2.0f * (nx * fx + ny * fy)) +
                                                    (xx * fx * fx + 2.0f * xy * fx * fy + yy * fy * fy);
    if (!(work < 0.0f)) return smooth;
    return minimum(1.0f, -2.0f * work / effort) * impulse;
}

// Whether one of the two bodies has joints.
bool joined(const SolverBodies& bodies, const ContactRecord& r) {
    auto has = [&](int32_t i) {
        return bodies.blocks[static_cast<size_t>(i / block_bodies)].joints[i % block_bodies] != 0.0f;
    };
    return has(r.body_a) || has(r.body_b);
}

// Finds what joints hand an impact on to, and puts it where it is then.
void reach(ImpactJoints& joints, SolverBodies& bodies, const ContactRecord& r, float time, bool first) {
    for (ReachedBody& reached : joints.reach(bodies, r.body_a, r.body_b)) {
        Side side(bodies, reached.body);
        side.aim({});
        const Moment m = side.after(time, first);
        reached.dp = load(side.state->dp) + (time * side.now.v + (0.5f * time * time) * side.acceleration);
        reached.dq = m.dq;
        if (side.movable()) reached.inverse_inertia = m.inverse_inertia;
    }
    joints.lock(bodies);
}

// What joints hand on of an impact.
void push_reached(SolverBodies& bodies, const Meeting& m, Vec3 impulse, float time, bool first, int sweep) {
    for (const ReachedBody& r : m.joints->hand_on(m.a.arm, m.b.arm, impulse)) {
        Side side(bodies, r.body);
        if (!side.movable()) continue;
        side.aim({});
        side.apply(side.after(time, first), r.impulse, r.angular_impulse, time, first);
        bodies.start[static_cast<size_t>(r.body)].struck = sweep;
    }
}

#include "solver/face_impact.inl"

// One point of a manifold, of which `a` and `b` are the bodies as they are; true where it bounced, and they are not any
// more.
bool bounce_point(SolverBodies& bodies, Side& a, Side& b, const ContactRecord& r, const ContactPointRecord& point,
                  const ContactExtra* extra, const SubstepConstants& k, int sweep, WatchedContact* watched,
                  ImpactJoints* joints) {
    const float slowest = slowest_bounce(r) * k.bounce_speed;
    const Nearing near = nearing_of(a, b, r, point, k.h);
    const Impact first = near.first;
    if (first.time > k.h || !(first.speed >= slowest)) return false;

    Vec3 n = near.normal;
    const bool balls = (r.flags & contact_balls) != 0;
    float time = first.time;
    Meeting m;
    m.inverse_masses = a.state->inverse_mass + b.state->inverse_mass;
    Vec3 between;  // from A's centre of mass to B's
    for (int times = 0;; ++times) {
        m.a = a.after(time, k.first);
        m.b = b.after(time, k.first);
        const Vec3 drift = b.now.v - a.now.v, acceleration = b.acceleration - a.acceleration;
        between = near.apart + (time * drift + (0.5f * time * time) * acceleration);
        if (balls) n = normalize(between + m.b.core - m.a.core, n);
        // Both get the impulse at one world point, on the surface of the body that it rides on.
        const Vec3 on_b = m.b.core - r.radius_b * n, from_a = on_b + between - (m.a.core + r.radius_a * n);
        m.b.arm = on_b - (1.0f - r.follow) * (from_a - dot(from_a, n) * n);
        m.a.arm = m.b.arm + between;
        // What turns follows no parabola: twice more by Newton's rule.
        const float off = dot(from_a, n), approach = dot(m.slip(), n);
        const bool turning = time > 0.0f && (a.turns() || b.turns());
        if (!(turning || balls) || times == 2 || !(absolute(off) > touching_gap) || !(approach < 0.0f)) break;
        time = maximum(time - off / approach, 0.0f);
        if (time > k.h) return false;
    }
    const float speed = -dot(m.slip(), n);
    if (!(speed >= slowest)) return false;

    if (joints && joined(bodies, r)) {
        reach(*joints, bodies, r, time, k.first);
        m.joints = joints;
    }
    const Vec3 impulse = impact_impulse(m, r, n, speed, extra);
    if (watched) {
        const Vec3 way = time * b.now.v + (0.5f * time * time) * b.acceleration;
        note_impact(*watched, speed, dot(impulse, n), n, load(b.state->dp) + way + m.b.arm);
    }
    if (m.joints) {
        push_reached(bodies, m, impulse, time, k.first, sweep);
        return true;
    }
    a.apply(m.a, -impulse, time, k.first);
    b.apply(m.b, impulse, time, k.first);
    if (a.movable()) bodies.start[static_cast<size_t>(r.body_a)].struck = sweep;
    if (b.movable()) bodies.start[static_cast<size_t>(r.body_b)].struck = sweep;
    return true;
}

// All points of a manifold; of `fresh` ones those that have carried nothing.
bool bounce_points(SolverBodies& bodies, const ContactRecord* records, const ImpactList& list, const ImpactContact& c,
                   bool fresh, const SubstepConstants& k, int sweep) {
    const ContactRecord& r = records[c.record];
    const ContactExtra* extra = list.extras ? list.extras + c.record : nullptr;
    WatchedContact* watched = list.watched.of(c.record);
    bool met = false;
    Side a(bodies, r.body_a), b(bodies, r.body_b);
    ContactPointRecord together;
    const Meet how = how_they_meet(a, b, records, list, c, fresh, k, together);
    if (how == Meet::none) return false;
    const bool at_once = how == Meet::at_once;
    for (int j = 0; j < (at_once ? 1 : r.point_count); ++j) {
        if (!at_once && fresh && r.normal_impulse[j] > 0.0f) continue;
        const ContactPointRecord& point = at_once ? together : r.points[j];
        if (!bounce_point(bodies, a, b, r, point, extra, k, sweep, watched, list.joints)) continue;
        met = true;
        a = Side(bodies, r.body_a), b = Side(bodies, r.body_b);
    }
    return met;
}

int larger(int a, int b) { return a > b ? a : b; }

}  // namespace

void mark_disturbed(const SolverBodies& bodies, BodyRange range, uint8_t* disturbed) {
    for (int i = range.begin; i < range.end; ++i) {
        if (disturbed[i]) continue;
        const BodyState& s = bodies.state[static_cast<size_t>(i)];
        const BodyBlock& block = bodies.blocks[static_cast<size_t>(i / block_bodies)];
        const int at = i % block_bodies;
        bool moved = false;
        for (int k = 0; k < 3; ++k)
            moved |= block.dv[k][at] != 0.0f || block.dL[k][at] != 0.0f || s.v[k] != block.v_ref[k][at] ||
                     s.w[k] != block.w_ref[k][at];
        disturbed[i] = moved;
    }
}

void follow_passing(const SolverBodies& bodies, ContactRecord& r) {
    const Vec3 n = load(r.normal), offset = load(r.arm_offset);
    const BodyState &a = bodies.state[static_cast<size_t>(r.body_a)], &b = bodies.state[static_cast<size_t>(r.body_b)];
    const float middle = 1e-5f * (r.radius_a + r.radius_b);  // that of a ball
    auto turned = [&](const BodyState& s, Vec3 core) {
        if (length_squared(core) <= middle * middle) return Vec3{};
        return rotate(Quat{s.dq[0], s.dq[1], s.dq[2], s.dq[3]}, core) - core;
    };
    for (int j = 0; j < r.point_count; ++j) {
        ContactPointRecord& p = r.points[j];
        const Vec3 ra = load(p.position), half_gap = (0.5f * p.separation) * n;
        const Vec3 core_a = ra - half_gap - r.radius_a * n, core_b = ra - offset + half_gap + r.radius_b * n;
        const Vec3 shift = (load(b.dp) + turned(b, core_b)) - (load(a.dp) + turned(a, core_a));
        if ((r.flags & contact_balls) != 0) {
            const float radii = r.radius_a + r.radius_b;
            p.separation = length((p.separation + radii) * n + shift) - radii;
        } else {
            p.separation += dot(n, shift);
        }
    }
}

bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, const ImpactList& list,
                     const SubstepConstants& k, int substep) {
    const int first_sweep = 1 + max_sweeps * substep;
    bool any = false;
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        bool bounced = false;
        const int number = first_sweep + sweep;
        for (int i = 0; i < list.count; ++i) {
            const uint32_t meets = sweep == 0 ? list.blocks[i / meeting_lanes].meets >> (i % meeting_lanes) : 0;
            // Until somebody is struck nothing comes of those that do not meet.
            if (sweep == 0 && !bounced && (meets & 1) == 0) {
                i += meets == 0 ? meeting_lanes - 1 - i % meeting_lanes : 0;
                continue;
            }
            const ImpactContact& c = list.contacts[i];
            const auto a = static_cast<size_t>(c.a), b = static_cast<size_t>(c.b);
            // Nothing has changed where nobody was struck in the last sweep or in this one.
            const int struck = larger(bodies.start[a].struck, bodies.start[b].struck);
            if ((meets & 1) == 0 && struck < larger(first_sweep, number - 1)) continue;
            if (c.passes && !(list.disturbed[a] | list.disturbed[b])) continue;
            if (sweep >= crowd_sweeps && c.crowded) continue;
            // What carries a load has met already: its bodies move against each other as far as the solver has not
            // found yet who carries whom, until a blow comes to one of them.
            const bool still = struck < first_sweep;
            if (still && c.held) continue;
            const bool met = bounce_points(bodies, records, list, c, still, k, number);
            bounced |= met;
            if (!met || !list.disturbed) continue;
            list.disturbed[a] = list.disturbed[b] = 1;
            if (!list.joints || !joined(bodies, records[c.record])) continue;
            for (const ReachedBody& reached : list.joints->reached()) list.disturbed[reached.body] = 1;
        }
        any |= bounced;
        if (!bounced) break;
    }
    return any;
}

}  // namespace lendulet
