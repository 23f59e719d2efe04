// Stages 5 and 7: awake bodies and their contacts into the solver's packed arrays, and back.
#include "dynamics/free_flight.h"
#include "math/decay.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int bodies_per_task = 256;

void put(float* p, Vec3 v) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }
Vec3 get(const float* p) { return {p[0], p[1], p[2]}; }

void pack_body(WorldData& world, size_t i, float h) {
    const BodyStore& bodies = world.bodies;
    uint32_t slot = world.awake[i];
    const BodyInfo& info = bodies.info[slot];
    const BodyMass& mass = bodies.mass[slot];
    const float dt = h * static_cast<float>(world.config.solver_steps);
    size_t k = i + reserved_bodies;
    bool dynamic = info.type == BodyType::dynamic;
    BodyStart start{};
    put(start.v, bodies.velocity(slot));
    put(start.w, bodies.angular_velocity(slot));
    world.solver_bodies.start[k] = start;
    BodyState s{};
    s.inverse_mass = dynamic ? mass.inverse_mass : 0.0f;
    s.dq[3] = 1.0f;
    world.solver_bodies.state[k] = s;

    BodyInertia inertia{};
    if (dynamic) {
        SymMat3 m = bodies.inverse_inertia_world(slot);
        float packed[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
        for (int c = 0; c < 6; ++c) inertia.inverse[c] = packed[c];
    }
    world.solver_bodies.inertia[k] = inertia;

    BodyMotion m{};
    Quat q = bodies.pose[slot].orientation;
    m.q0[0] = q.x, m.q0[1] = q.y, m.q0[2] = q.z, m.q0[3] = q.w;
    m.anisotropy = 1.0f;
    m.free = 1.0f;
    if (dynamic) {
        Decay linear = decay(info.linear_damping, h), angular = decay(info.angular_damping, h);
        put(m.inertia, mass.inertia);
        put(m.inverse_inertia, mass.inverse_inertia);
        m.linear_loss = linear.loss;
        m.angular_loss = angular.loss;
        m.anisotropy = mass.anisotropy;
        put(m.angular_momentum, bodies.momenta[slot].L);
        put(m.acceleration, linear.mean * acceleration(world, slot, dt));
        put(m.torque, angular.mean * torque(world, slot, dt));
        put(m.change_v, bodies.change[slot].v);
        put(m.change_L, bodies.change[slot].L);
    }
    world.solver_bodies.motion[k] = m;
}

// p += dp and x += dx with the rounding error kept (Kahan 1965): a body that glides far from the origin would lose a
// share of every step, always the same one.
void add_momentum(BodyMomenta& m, Vec3 dp) {
    Vec3 y = dp - m.p_low, t = m.p + y;
    m.p_low = (t - m.p) - y;
    m.p = t;
}
void add_displacement(Position& x, Vec3& low, Vec3 dx) {
    Vec3 y = dx - low;
    Position t = x + y;
    low = (t - x) - y;
    x = t;
}

// What a body alone does under the chosen reference integrator.
void fly(WorldData& world, uint32_t slot, float dt) {
    BodyStore& bodies = world.bodies;
    const BodyInfo& info = bodies.info[slot];
    const BodyMass& mass = bodies.mass[slot];
    FlightBody body{mass.inverse_mass,       mass.inverse_inertia, mass.mass * acceleration(world, slot, dt),
                    torque(world, slot, dt), info.linear_damping,  info.angular_damping};
    FlightState s{{}, bodies.pose[slot].orientation, bodies.momenta[slot].p, bodies.momenta[slot].L};
    float h = dt / static_cast<float>(world.config.solver_steps);
    for (int i = 0; i < world.config.solver_steps; ++i) s = advance(s, body, world.config.integrator, h);
    BodyMomenta& momenta = bodies.momenta[slot];
    add_displacement(bodies.pose[slot].position, momenta.x_low, s.x);
    bodies.pose[slot].orientation = s.q;
    momenta.p = s.p;
    momenta.L = s.L;
}

void unpack_body(WorldData& world, size_t i, float dt) {
    BodyStore& bodies = world.bodies;
    uint32_t slot = world.awake[i];
    const BodyInfo& info = bodies.info[slot];
    const BodyState& s = world.solver_bodies.state[i + reserved_bodies];
    const BodyMotion& m = world.solver_bodies.motion[i + reserved_bodies];
    bool dynamic = info.type == BodyType::dynamic;
    if (dynamic && m.free > 0.0f && world.config.integrator != Integrator::momentum) {
        fly(world, slot, dt);
        return;
    }
    Pose& pose = bodies.pose[slot];
    BodyMomenta& momenta = bodies.momenta[slot];
    add_displacement(pose.position, momenta.x_low, get(s.dp));
    pose.orientation = normalize(Quat{s.dq[0], s.dq[1], s.dq[2], s.dq[3]} * pose.orientation);
    if (!dynamic) return;
    if (m.free > 0.0f) {  // exactly: m g dt, not what is left of it after adding to a large velocity
        Decay whole = decay(info.linear_damping, dt);
        add_momentum(momenta, (whole.mean * dt * bodies.mass[slot].mass) * acceleration(world, slot, dt) -
                                  whole.loss * momenta.p);
    } else {
        add_momentum(momenta, bodies.mass[slot].mass * get(s.v));
    }
    momenta.L = get(m.angular_momentum);
    bodies.change[slot] = {get(m.change_v), get(m.change_L)};
}

}  // namespace

void pack_bodies(WorldData& world, float h) {
    BodyStore& bodies = world.bodies;
    world.awake.clear();
    for (uint32_t slot : bodies.slots.order()) {
        BodyInfo& info = bodies.info[slot];
        const BodyMomenta& m = bodies.momenta[slot];
        bool packed = info.type == BodyType::dynamic
                          ? !info.asleep
                          : info.type == BodyType::kinematic && length_squared(m.p) + length_squared(m.L) > 0.0f;
        info.solver_index = packed ? reserved_bodies + world.awake.count() : static_body;
        if (packed) world.awake.push_back(slot);
    }
    world.solver_bodies.reset(world.awake.count());
    world.tasks.for_each(world.awake.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) pack_body(world, static_cast<size_t>(i), h);
    });
}

void pack_contacts(WorldData& world) {
    world.active.clear();
    for (uint32_t i : world.touching) {
        ContactRecord& r = world.records[i];
        const ColliderPair& p = world.pairs.now[r.pair];
        bool flipped = (r.flags & contact_flipped) != 0;
        uint32_t body_a = world.colliders.info[flipped ? p.b : p.a].body,
                 body_b = world.colliders.info[flipped ? p.a : p.b].body;
        const BodyInfo &a = world.bodies.info[body_a], &b = world.bodies.info[body_b];
        if (b.asleep || b.type != BodyType::dynamic)
            continue;  // B moves wherever one of them does, and islands wake as one
        r.body_a = a.solver_index;
        r.body_b = b.solver_index;
        world.solver_bodies.motion[static_cast<size_t>(r.body_a)].free = 0.0f;
        world.solver_bodies.motion[static_cast<size_t>(r.body_b)].free = 0.0f;
        world.active.push_back(i);
    }
}

void unpack_bodies(WorldData& world, float dt, bool forces_end) {
    BodyStore& bodies = world.bodies;
    world.tasks.for_each(world.awake.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            uint32_t slot = world.awake[static_cast<size_t>(i)];
            Pose before = bodies.pose[slot];
            unpack_body(world, static_cast<size_t>(i), dt);
            BodyInfo& info = bodies.info[slot];
            info.capped |= info.type == BodyType::dynamic && cap_speed(bodies, slot);
            const BodyMomenta& m = bodies.momenta[slot];
            const Pose& pose = bodies.pose[slot];
            bool sound = is_finite(from_origin(pose.position)) && is_finite(m.p) && is_finite(m.L) &&
                         dot(pose.orientation, pose.orientation) < 2.0f;
            info.contained = !sound;
            if (!sound) {  // put back and stopped, so that it cannot spoil others
                bodies.pose[slot] = before;
                bodies.momenta[slot] = {};
                bodies.change[slot] = {};
            }
            if (forces_end) bodies.forces[slot] = {}, info.has_forces = false;
        }
    });
    world.statistics.capped_bodies = world.statistics.contained_bodies = 0;
    for (uint32_t slot : world.awake) {
        world.statistics.capped_bodies += bodies.info[slot].capped;
        world.statistics.contained_bodies += bodies.info[slot].contained;
    }
}

}  // namespace lendulet
