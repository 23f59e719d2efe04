#include "solver/impacts.h"

#include "lendulet/math.h"

namespace lendulet {
namespace {

constexpr int max_sweeps = 8;
// Points closer than this count as touching already: positions a metre from the body's centre resolve 1e-7 m.
constexpr float touching = 1e-6f;

Vec3 load(const float* p) { return {p[0], p[1], p[2]}; }
void add(float* p, Vec3 v) { p[0] += v.x, p[1] += v.y, p[2] += v.z; }

struct Side {
    BodyState* state;
    BodyInertia* inertia;
    BodyBlock* block;
    int at;  // of the body in its block
    SymMat3 inverse_inertia;
    Vec3 v, w, arm;  // whole velocities

    Side(SolverBodies& bodies, int32_t i)
        : state(&bodies.state[static_cast<size_t>(i)]),
          inertia(&bodies.inertia[static_cast<size_t>(i)]),
          block(&bodies.blocks[static_cast<size_t>(i / block_bodies)]),
          at(i % block_bodies) {
        const float* m = inertia->inverse;
        inverse_inertia = {m[0], m[1], m[2], m[3], m[4], m[5]};
        const BodyStart& start = bodies.start[static_cast<size_t>(i)];
        v = load(start.v) + load(state->v);
        w = load(start.w) + load(state->w);
    }
    Quat rotation() const { return {state->dq[0], state->dq[1], state->dq[2], state->dq[3]}; }
    bool movable() const { return state->inverse_mass > 0.0f; }
    Vec3 acceleration() const { return movable() ? lanes(block->acceleration) : Vec3{}; }
    Vec3 lanes(const BodyBlock::Lanes* p) const { return {p[0][at], p[1][at], p[2][at]}; }
    void add_lanes(BodyBlock::Lanes* p, Vec3 d) const { p[0][at] += d.x, p[1][at] += d.y, p[2][at] += d.z; }
    Vec3 velocity() const { return v + cross(w, arm); }
    // T^-1(u), thesis 3.3.2: how much the point's velocity along u changes per unit impulse.
    float effectiveness(Vec3 u) const {
        Vec3 r = cross(arm, u);
        return state->inverse_mass + dot(r, inverse_inertia * r);
    }
    // What the relax pass changed goes into L by the inertia that it saw, before the body turns.
    void settle_changes() {
        const BodyBlock::Lanes* q0 = block->q0;
        const Quat q = Quat{state->dq[0], state->dq[1], state->dq[2], state->dq[3]} *
                       Quat{q0[0][at], q0[1][at], q0[2][at], q0[3][at]};
        const Vec3 dw = load(state->w) - lanes(block->w_ref);
        const Vec3 dL = rotate(q, multiply(lanes(block->inertia), rotate_inverse(q, dw)));
        add_lanes(block->L, dL);
        add_lanes(block->dL, dL);
        for (int k = 0; k < 3; ++k) block->w_ref[k][at] = state->w[k];
    }
    // The impulse acts after `time`: the body is moved so that from then on it is where the new velocity leads.
    void apply(Vec3 impulse, float time, bool first) {
        if (!movable()) return;
        if (!first) settle_changes();
        Vec3 dv = state->inverse_mass * impulse, dL = cross(arm, impulse), dw = inverse_inertia * dL;
        v += dv;
        w += dw;
        add(state->v, dv);
        add(state->w, dw);
        // Not a change that the warm start repeats, nor one that the drift expects to go on.
        add_lanes(block->v_ref, dv);
        add_lanes(block->v_start, dv);
        add_lanes(block->w_ref, dw);
        add_lanes(block->L_start, dL);
        add_lanes(block->L, dL);
        const Vec3 shift = -time * dv;
        add(state->dp, shift);
        // What contacts hold and the kick will repeat acts at other arms now.
        if (!first && block->joints[at] == 0.0f) {
            const Vec3 held = lanes(block->dv) + (load(state->v) - lanes(block->v_ref));
            add_lanes(block->dL, (-1.0f / state->inverse_mass) * cross(shift, held));
        }
        Vec3 turn = (-0.5f * time) * dw;
        Quat q = rotation();
        Quat d = normalize(Quat{turn.x, turn.y, turn.z, 1.0f} * q);
        state->dq[0] = d.x, state->dq[1] = d.y, state->dq[2] = d.z, state->dq[3] = d.w;
        // What changes w from here on is put into L by the inertia of this orientation.
        const BodyBlock::Lanes* q0 = block->q0;
        const Quat now = d * Quat{q0[0][at], q0[1][at], q0[2][at], q0[3][at]};
        inverse_inertia =
            rotate_diagonal(rotation_matrix<float>(QuatT<float>(now), 1.0f), lanes(block->inverse_inertia));
        const SymMat3& m = inverse_inertia;
        const float inverse[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
        for (int i = 0; i < 6; ++i) inertia->inverse[i] = inverse[i];
    }
};

// How the velocity along u changes per unit impulse along n.
float coupling(const Side& s, Vec3 u, Vec3 n) { return dot(cross(s.arm, u), s.inverse_inertia * cross(s.arm, n)); }

// The largest impulse f against the slip s along u with which the impact adds no energy. The impulse J along n alone
// takes `lost` of it, f changes it by K_uu f^2 / 2 - s f - K_un J f: bodies other than balls answer along both to
// either.
float elastic_limit(const Side& a, const Side& b, Vec3 n, Vec3 u, float normal_impulse, float slide, float lost) {
    float effective = a.effectiveness(u) + b.effectiveness(u);
    float pull = slide + (coupling(a, u, n) + coupling(b, u, n)) * normal_impulse;
    return (pull + square_root(pull * pull + 2.0f * effective * lost)) / effective;
}

// One point of a manifold; true where it bounced.
bool bounce_point(SolverBodies& bodies, const ContactRecord& r, const ContactPointRecord& point,
                  float tangential_restitution, const SubstepConstants& k) {
    Side a(bodies, r.body_a), b(bodies, r.body_b);
    Vec3 n = load(r.normal), ra0 = load(point.position), offset = load(r.arm_offset), rb0 = ra0 - offset;
    float half_gap = 0.5f * point.separation;
    // Separation now: core points turn with their bodies, swept surfaces do not.
    Vec3 core_a = ra0 - (half_gap + r.radius_a) * n, core_b = rb0 + (half_gap + r.radius_b) * n;
    Vec3 moved = load(b.state->dp) - load(a.state->dp);
    Vec3 turned = (rotate(b.rotation(), core_b) - core_b) - (rotate(a.rotation(), core_a) - core_a);
    float gap = maximum(point.separation + dot(n, moved + turned), 0.0f);
    // Both get the impulse at the same world point at the time of impact, on the surface of the body that it rides on.
    Vec3 drift = b.v - a.v;
    auto place_arms = [&](float time) {
        Vec3 shift = moved + time * drift, slid = shift - dot(shift, n) * n;
        b.arm = rb0 + half_gap * n - (1.0f - r.follow) * slid;
        a.arm = b.arm + offset + shift;
    };
    place_arms(0.0f);
    float approach = dot(b.velocity() - a.velocity(), n), acceleration = dot(b.acceleration() - a.acceleration(), n);
    // gap + approach t + acceleration t^2 / 2 = 0, the earlier root; stable form.
    float discriminant = approach * approach - 2.0f * acceleration * gap;
    if (!(discriminant > 0.0f)) return false;
    float speed = square_root(discriminant), time = 0.0f;
    if (gap > touching) {
        float denominator = speed - approach;
        if (!(denominator > 0.0f)) return false;
        time = 2.0f * gap / denominator;
    } else if (approach >= 0.0f) {
        return false;
    }
    if (time > k.h || speed < k.bounce_speed) return false;
    place_arms(time);
    Vec3 relative = b.velocity() - a.velocity();

    float normal_impulse = (1.0f + r.restitution) * speed / (a.effectiveness(n) + b.effectiveness(n));
    Vec3 impulse = normal_impulse * n, slip = relative - dot(relative, n) * n;
    float slide = length(slip);
    if (slide > 1e-9f) {
        Vec3 u = (1.0f / slide) * slip;
        float stopping = (1.0f + tangential_restitution) * slide / (a.effectiveness(u) + b.effectiveness(u));
        // Static and sliding friction on the whole normal impulse (thesis 3.3.4, magnitudes as in THESIS-NOTES).
        float friction =
            stopping <= r.static_friction * normal_impulse ? stopping : r.dynamic_friction * normal_impulse;
        float lost = 0.5f * (1.0f - r.restitution) * speed * normal_impulse;
        impulse -= minimum(friction, elastic_limit(a, b, n, u, normal_impulse, slide, lost)) * u;
    }
    a.apply(-impulse, time, k.first);
    b.apply(impulse, time, k.first);
    return true;
}

}  // namespace

bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, BouncingList bouncing,
                     const SubstepConstants& k) {
    bool any = false;
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        bool bounced = false;
        for (int i = 0; i < bouncing.count; ++i) {
            const uint32_t record = bouncing.list[i];
            const ContactRecord& r = records[record];
            const float back = bouncing.extras ? bouncing.extras[record].tangential_restitution : 0.0f;
            for (int j = 0; j < r.point_count; ++j) bounced |= bounce_point(bodies, r, r.points[j], back, k);
        }
        any |= bounced;
        if (!bounced) break;
    }
    return any;
}

}  // namespace lendulet
