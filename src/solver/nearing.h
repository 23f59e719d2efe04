// Two bodies of a contact on their way through a substep, and how they near each other at a point: what impacts and
// watched contacts have in common.
#pragma once

#include "lendulet/math.h"
#include "math/turned.h"
#include "math/wide/mask.h"
#include "math/wide/wide.h"
#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/impacts.h"

namespace lendulet {
namespace {

#include "solver/turn.inl"

inline Vec3 load(const float* p) { return {p[0], p[1], p[2]}; }
inline void add(float* p, Vec3 v) { p[0] += v.x, p[1] += v.y, p[2] += v.z; }

// A body at some moment of the substep, and the point of it that is hit.
struct Moment {
    Quat dq;  // rotation since the start of the step
    SymMat3 inverse_inertia;
    Vec3 v, w, L;  // whole velocities
    Vec3 core;     // of the point, from the centre of mass
    Vec3 arm;
};

struct Side {
    BodyState* state;
    BodyInertia* inertia;
    BodyBlock* block;
    int at;  // of the body in its block
    Vec3 start_w, core0;
    Vec3 acceleration, spin_up;  // of the centre of mass, and of the spin at constant L
    Moment now;

    Side(SolverBodies& bodies, int32_t i)
        : state(&bodies.state[static_cast<size_t>(i)]),
          inertia(&bodies.inertia[static_cast<size_t>(i)]),
          block(&bodies.blocks[static_cast<size_t>(i / block_bodies)]),
          at(i % block_bodies) {
        const float* m = inertia->inverse;
        const BodyStart& start = bodies.start[static_cast<size_t>(i)];
        start_w = load(start.w);
        now.dq = {state->dq[0], state->dq[1], state->dq[2], state->dq[3]};
        now.inverse_inertia = {m[0], m[1], m[2], m[3], m[4], m[5]};
        now.v = load(start.v) + load(state->v);
        now.w = start_w + load(state->w);
        if (!movable()) return;
        acceleration = lanes(block->acceleration);
        spin_up = now.inverse_inertia * cross(lanes(block->L), now.w);
    }
    // Takes another point, by its core at the start of the step.
    void aim(Vec3 core) {
        core0 = core;
        now.core = rotate(now.dq, core);
    }
    bool movable() const { return state->inverse_mass > 0.0f; }
    bool turns() const { return length_squared(now.w) > 0.0f; }
    // Of the core point: with what turning about the centre of mass adds, also where the axis itself turns.
    Vec3 core_acceleration() const {
        return acceleration + (cross(now.w, cross(now.w, now.core)) + cross(spin_up, now.core));
    }
    Vec3 lanes(const BodyBlock::Lanes* p) const { return {p[0][at], p[1][at], p[2][at]}; }
    void add_lanes(BodyBlock::Lanes* p, Vec3 d) const { p[0][at] += d.x, p[1][at] += d.y, p[2][at] += d.z; }
    Quat orientation(Quat dq) const {
        const BodyBlock::Lanes* q0 = block->q0;
        return dq * Quat{q0[0][at], q0[1][at], q0[2][at], q0[3][at]};
    }
    bool is_round() const { return block->anisotropy[at] <= 1.0f; }
    SymMat3 inverse_inertia_at(Quat dq) const {
        if (is_round()) return now.inverse_inertia;
        return rotate_diagonal(rotation_matrix<float>(QuatT<float>(orientation(dq)), 1.0f),
                               lanes(block->inverse_inertia));
    }
    // `inverse`: of its inertia where it is turned by dq.
    Quat turned(Quat dq, Vec3 L, Vec3 w, const SymMat3& inverse, float time) const {
        return to_quat(turn_at_constant_L<1>(dq, orientation({}), L, lanes(block->inverse_inertia), w,
                                             block->anisotropy[at], inverse, time));
    }
    // What the relax pass changed goes into L by the inertia that it saw, before the body turns.
    Vec3 unsettled() const {
        const Vec3 dw = load(state->w) - lanes(block->w_ref);
        if (is_round()) return block->inertia[0][at] * dw;
        const Quat q = orientation(now.dq);
        return rotate(q, multiply(lanes(block->inertia), rotate_inverse(q, dw)));
    }
    // The body when it has flown on for `time`, as it will: at constant angular momentum.
    Moment after(float time, bool first) const {
        Moment m = now;
        m.L = {};
        if (movable()) m.L = lanes(block->L) + (first ? Vec3{} : unsettled());
        if (time > 0.0f) {
            m.v = now.v + time * acceleration;
            if (turns()) {
                m.dq = turned(now.dq, m.L, now.w, now.inverse_inertia, time);
                m.core = rotate(m.dq, core0);
            }
        }
        if (movable()) {
            if (time > 0.0f) m.inverse_inertia = inverse_inertia_at(m.dq), m.L += time * lanes(block->torque);
            m.w = m.inverse_inertia * m.L;
        }
        return m;
    }
    // The impulse acts on the body as it is at `m`, `time` from now: it is put where the new momenta, back from there,
    // would have had it begin, so that from then on it is where they lead.
    void apply(const Moment& m, Vec3 impulse, float time, bool first) const {
        apply(m, impulse, cross(m.arm, impulse), time, first);
    }
    // The same with an angular impulse dL about the centre of mass.
    void apply(const Moment& m, Vec3 impulse, Vec3 dL, float time, bool first) const {
        if (!movable()) return;
        const Vec3 dv = state->inverse_mass * impulse;
        if (!first) {
            const Vec3 changed = unsettled();
            add_lanes(block->L, changed);
            add_lanes(block->dL, changed);
        }
        add(state->v, dv);
        add_lanes(block->L, dL);
        // Not a change that the warm start repeats, nor one that the drift expects to go on.
        add_lanes(block->v_ref, dv);
        add_lanes(block->v_start, dv);
        add_lanes(block->L_start, dL);
        const Vec3 shift = -time * dv;
        add(state->dp, shift);
        // What contacts with moving bodies hold and the kick will repeat acts at other arms now. What the ground holds
        // does not: a ball's contact goes with it. Billiard balls lost and gained 2 % by taking that for the same.
        if (!first && block->joints[at] == 0.0f && block->free[at] == -1.0f) {
            const Vec3 held = lanes(block->dv) + (load(state->v) - lanes(block->v_ref));
            add_lanes(block->dL, (-1.0f / state->inverse_mass) * cross(shift, held));
        }
        SymMat3 inverse = m.inverse_inertia;
        if (time > 0.0f) {
            const Vec3 L = m.L + dL;
            const Quat d = turned(m.dq, -L, -(inverse * L), inverse, time);
            state->dq[0] = d.x, state->dq[1] = d.y, state->dq[2] = d.z, state->dq[3] = d.w;
            inverse = inverse_inertia_at(d);
        }
        const Vec3 w = inverse * lanes(block->L) - start_w;
        for (int k = 0; k < 3; ++k) state->w[k] = component(w, k), block->w_ref[k][at] = component(w, k);
        // What changes w from here on is put into L by the inertia of this orientation.
        const float packed[6] = {inverse.xx, inverse.yy, inverse.zz, inverse.xy, inverse.xz, inverse.yz};
        for (int i = 0; i < 6; ++i) inertia->inverse[i] = packed[i];
    }
};

// The earlier root of gap + approach t + acceleration t^2 / 2 = 0 in its stable form, and the speed then; speed 0 where
// there is none.
struct Impact {
    float time, speed;
};
inline Impact impact_of(float gap, float approach, float acceleration) {
    const float discriminant = approach * approach - 2.0f * acceleration * gap;
    if (!(discriminant > 0.0f)) return {};
    const float speed = square_root(discriminant);
    if (!(gap > touching_gap)) return {0.0f, approach < 0.0f ? speed : 0.0f};
    const float denominator = speed - approach;
    return denominator > 0.0f ? Impact{2.0f * gap / denominator, speed} : Impact{};
}

// When two balls whose centres are `way` apart and move by `v` against each other are `radii` apart, or nearest, within
// [0, h], without acceleration.
inline float time_to_meet(Vec3 way, Vec3 v, float radii, float h) {
    const float speed2 = length_squared(v), closing = -dot(way, v), beyond = length_squared(way) - radii * radii;
    if (!(closing > 0.0f) || !(beyond > 0.0f)) return 0.0f;
    const float discriminant = closing * closing - speed2 * beyond;
    const float time = discriminant > 0.0f ? beyond / (closing + square_root(discriminant)) : closing / speed2;
    return minimum(time, h);
}

// How two bodies near each other at a point of their contact.
struct Nearing {
    Vec3 normal;     // now, from A to B
    Vec3 apart;      // from A's centre of mass to B's
    float approach;  // how fast the gap grows, m/s
    Impact first;    // when they meet as they move and accelerate
};
inline Nearing nearing_of(Side& a, Side& b, const ContactRecord& r, const ContactPointRecord& point, float h) {
    const Vec3 n0 = load(r.normal), ra0 = load(point.position), offset = load(r.arm_offset);
    const float half_gap = 0.5f * point.separation;
    // Core points turn with their bodies, swept surfaces do not.
    a.aim(ra0 - (half_gap + r.radius_a) * n0);
    b.aim(ra0 - offset + (half_gap + r.radius_b) * n0);
    // The normal of a face that a corner meets turns with its body, see turn_row().
    Vec3 n = turns_with_face(r) ? rotate((r.follow > 0.5f ? a : b).now.dq, n0) : n0;
    const Vec3 apart = offset + (load(b.state->dp) - load(a.state->dp));
    const Vec3 turned = (b.now.core - b.core0) - (a.now.core - a.core0);
    float gap = maximum(dot(n, n0) * point.separation + dot(n, (apart - offset) + turned), 0.0f);
    const Vec3 v = (b.now.v + cross(b.now.w, b.now.core)) - (a.now.v + cross(a.now.w, a.now.core));
    const bool balls = (r.flags & contact_balls) != 0;
    if (balls) {
        const float radii = r.radius_a + r.radius_b;
        const Vec3 way = apart + b.now.core - a.now.core, met = way + time_to_meet(way, v, radii, h) * v;
        n = normalize(met, n0);
        gap = maximum(dot(n, way) - radii, 0.0f);
    }
    const float approach = dot(v, n), acceleration = dot(b.core_acceleration() - a.core_acceleration(), n);
    return {n, apart, approach, impact_of(gap, approach, acceleration)};
}

}  // namespace
}  // namespace lendulet
