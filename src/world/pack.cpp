// Stages 5 and 7: awake bodies and their contacts into the solver's packed arrays, and back.
#include <atomic>

#include "base/prefetch.h"
#include "dynamics/free_flight.h"
#include "math/decay.h"
#include "world/narrow/manifold_records.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int bodies_per_task = 256, contacts_per_task = 512;

void put(float* p, Vec3 v) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }
Vec3 get(const float* p) { return {p[0], p[1], p[2]}; }

// How many substeps of its own a body takes in one of the setting: 1, 2, 4, 8, or less than one. What is kept from step
// to step, impulses and changes, is in units of the setting's substep.
float multiple(const WorldData& world, int32_t solver_body) {
    if (solver_body >= world.alone.begin) return 1.0f / static_cast<float>(world.config.solver_steps);
    int c = 0;
    while (solver_body >= world.parts[c].bodies.end) ++c;
    return static_cast<float>(1 << c);
}

// As BodyMotion::free.
float freedom(const WorldData& world, uint32_t slot) {
    if (slot >= world.island_loads.size()) return 1.0f;
    const IslandLoad& l = world.island_loads[slot];
    if (l.step != world.steps + 1 || !l.touches) return 1.0f;
    return l.meets_moving ? -1.0f : 0.0f;
}

void pack_body(WorldData& world, uint32_t slot, float dt) {
    const BodyStore& bodies = world.bodies;
    const BodyInfo& info = bodies.info[slot];
    const BodyMass& mass = bodies.mass[slot];
    const float share = 1.0f / multiple(world, info.solver_index);
    const float h = share * dt / static_cast<float>(world.config.solver_steps);
    size_t k = static_cast<size_t>(info.solver_index);
    bool dynamic = info.type == BodyType::dynamic;
    BodyStart start{};
    put(start.v, bodies.velocity(slot));
    put(start.w, bodies.angular_velocity(slot));
    world.solver_bodies.start[k] = start;
    BodyPlace place{};
    put(place.x, from_origin(bodies.pose[slot].position));
    put(place.x_low, bodies.momenta[slot].x_low);
    world.solver_bodies.place[k] = place;
    BodyState s{};
    s.inverse_mass = dynamic ? mass.inverse_mass : 0.0f;
    put(s.dq, bodies.momenta[slot].turn_low);
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
        m.free = freedom(world, slot);
        Decay linear = decay(info.linear_damping, h), angular = decay(info.angular_damping, h);
        put(m.inertia, mass.inertia);
        put(m.inverse_inertia, mass.inverse_inertia);
        m.linear_loss = linear.loss;
        m.angular_loss = angular.loss;
        m.anisotropy = mass.anisotropy;
        put(m.angular_momentum, bodies.momenta[slot].L);
        put(m.acceleration, linear.mean * acceleration(world, slot, dt));
        put(m.torque, angular.mean * torque(world, slot, dt));
        put(m.change_v, share * bodies.change[slot].v);
        put(m.change_L, share * bodies.change[slot].L);
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
// q <- dq q, where dq began with what rounding q took before, and leaves that anew in `low`. An orientation is rounded
// to 6e-8 rad, in every step again and not evenly: in ten minutes of steps of 1/240 s a top fell by 0.015 degrees.
void add_turn(Quat& q, Vec3& low, Quat dq) {
    // dq (1 + half of what |q| lacks of 1) - 1, without cancellation.
    const float grow = dq.w > 0.0f ? -(dq.x * dq.x + dq.y * dq.y + dq.z * dq.z) / (1.0f + dq.w) : dq.w - 1.0f;
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const auto lack = static_cast<float>(0.5 * (1.0 - (x * x + y * y + z * z + w * w)));
    const Quat d = Quat{dq.x + lack * dq.x, dq.y + lack * dq.y, dq.z + lack * dq.z, grow + lack * dq.w} * q;
    const Quat t{q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
    const Quat lost{d.x - (t.x - q.x), d.y - (t.y - q.y), d.z - (t.z - q.z), d.w - (t.w - q.w)};
    const Quat turn = lost * conjugate(t);
    low = {turn.x, turn.y, turn.z};
    q = t;
}

// Impulses of contacts with more substeps from units of the setting's substep to those of their own, or back: powers of
// two, so nothing is rounded.
void scale_impulses(WorldData& world, int sign) {
    for (int c = 1; c < substep_classes; ++c) {
        float factor = sign > 0 ? static_cast<float>(1 << c) : 1.0f / static_cast<float>(1 << c);
        const SolverPart& part = world.parts[c];
        for (int i = 0; i < part.contact_count; ++i) {
            ContactRecord& r = world.records[world.active[static_cast<size_t>(part.first_contact + i)]];
            for (float& x : r.normal_impulse) x *= factor;
            for (float& x : r.friction_impulse) x *= factor;
            r.twist_impulse *= factor;
        }
    }
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
    momenta.turn_low = {};
    momenta.p = s.p;
    momenta.L = s.L;
}

// Kinematic bodies that something touches; there are few, if any.
void tie_kinematic(WorldData& world) {
    for (const ContactEnds& e : world.active_ends)
        if (e.fixed_a) world.solver_bodies.motion[static_cast<size_t>(e.a)].free = 0.0f;
}

// The active contacts by class, and in each those that pass last; stably. Most often there is but one class.
void sort_by_class(WorldData& world) {
    int counts[2 * substep_classes] = {}, first = 0;
    auto class_of = [&](const ContactEnds& e) {
        int c = 0;
        while (e.b >= world.parts[c].bodies.end) ++c;
        return c;
    };
    auto list_of = [&](const ContactEnds& e) { return 2 * (world.hard_bodies == 0 ? 0 : class_of(e)) + e.passes; };
    for (const ContactEnds& e : world.active_ends) ++counts[list_of(e)];
    for (int c = 0; c < substep_classes; ++c) {
        SolverPart& part = world.parts[c];
        part.first_contact = first;
        part.row_count = counts[2 * c];
        part.contact_count = counts[2 * c] + counts[2 * c + 1];
        counts[2 * c] = first, counts[2 * c + 1] = first + part.row_count;
        first += part.contact_count;
    }
    if (world.parts[0].row_count == first) return;
    world.unsorted.swap(world.active);
    world.unsorted_ends.swap(world.active_ends);
    world.active.resize_unset(world.unsorted.size());
    world.active_ends.resize_unset(world.unsorted.size());
    for (size_t i = 0; i < world.unsorted.size(); ++i) {
        const auto k = static_cast<size_t>(counts[list_of(world.unsorted_ends[i])]++);
        world.active[k] = world.unsorted[i];
        world.active_ends[k] = world.unsorted_ends[i];
    }
}

void unpack_body(WorldData& world, uint32_t slot, float dt) {
    BodyStore& bodies = world.bodies;
    const BodyInfo& info = bodies.info[slot];
    const BodyState& s = world.solver_bodies.state[static_cast<size_t>(info.solver_index)];
    const BodyMotion& m = world.solver_bodies.motion[static_cast<size_t>(info.solver_index)];
    bool dynamic = info.type == BodyType::dynamic;
    if (dynamic && m.free > 0.0f && world.config.integrator != Integrator::momentum) {
        fly(world, slot, dt);
        return;
    }
    Pose& pose = bodies.pose[slot];
    BodyMomenta& momenta = bodies.momenta[slot];
    add_displacement(pose.position, momenta.x_low, get(s.dp));
    add_turn(pose.orientation, momenta.turn_low, {s.dq[0], s.dq[1], s.dq[2], s.dq[3]});
    if (!dynamic) return;
    if (m.free > 0.0f) {  // exactly: m g dt, not what is left of it after adding to a large velocity
        Decay whole = decay(info.linear_damping, dt);
        add_momentum(momenta, (whole.mean * dt * bodies.mass[slot].mass) * acceleration(world, slot, dt) -
                                  whole.loss * momenta.p);
    } else {
        add_momentum(momenta, bodies.mass[slot].mass * get(s.v));
    }
    momenta.L = get(m.angular_momentum);
    float substeps = multiple(world, info.solver_index);
    bodies.change[slot] = {substeps * get(m.change_v), substeps * get(m.change_L)};
}

}  // namespace

void pack_bodies(WorldData& world, float dt) {
    const Array<uint32_t>& list = world.awake;
    world.tasks.for_each(list.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) pack_body(world, list[static_cast<size_t>(i)], dt);
    });
    if (world.has_packed_kinematic) tie_kinematic(world);
}

void pack_contacts(WorldData& world) {
    Array<ContactEnds>& ends = world.active_ends;
    ends.resize_unset(world.active.size());
    auto place_of = [&](uint32_t slot) { return world.bodies.info[slot].solver_index; };
    world.tasks.for_each(ends.count(), contacts_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            const TouchingBodies& t = world.active_bodies[i];
            ends[i] = {place_of(t.a), place_of(t.b), t.kind, t.fixed_a, t.bounces, t.impulse == 0.0f, t.passes};
        }
    });
    sort_by_class(world);
    cut_contacts(world);
    world.tasks.for_each(ends.count(), contacts_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            if (i + prefetch_distance < ends.size()) prefetch(&world.records[world.active[i + prefetch_distance]]);
            ContactRecord& r = world.records[world.active[i]];
            r.body_a = ends[i].a;
            r.body_b = ends[i].b;
        }
    });
    scale_impulses(world, -1);
}

void unpack_contacts(WorldData& world) { scale_impulses(world, 1); }

namespace {

bool all_finite(const float* x, int count) {
    float sum = 0.0f;
    for (int i = 0; i < count; ++i) sum += x[i];
    return is_finite(sum);
}

// Where one impulse of a joint is no number none of its others is to be trusted.
void forget_joint_impulses(WorldData& world) {
    for (JointRecord& r : world.joint_records) {
        const float held[] = {r.limit_0, r.limit_1, r.motor, r.spring};
        bool finite = all_finite(r.linear, 3) && all_finite(r.angular, 3) && all_finite(held, 4) &&
                      all_finite(r.impulse, 3) && all_finite(r.angular_impulse, 3);
        JointAxesRecord* axes =
            r.type == JointClass::six_degrees ? &world.joint_axes[static_cast<size_t>(r.axes)] : nullptr;
        for (int k = 0; axes && k < joint_axes; ++k) {
            const JointAxisRecord& x = axes->axis[k];
            finite = finite && is_finite(x.limit + x.motor + x.spring);
        }
        if (finite) continue;
        for (float* x : {r.linear, r.angular, r.impulse, r.angular_impulse}) x[0] = x[1] = x[2] = 0.0f;
        r.limit_0 = r.limit_1 = r.motor = r.spring = 0.0f;
        for (int k = 0; axes && k < joint_axes; ++k) {
            JointAxisRecord& x = axes->axis[k];
            x.limit = x.motor = x.spring = 0.0f;
        }
    }
}

// What held a body whose state had to be put back is no number to begin the next step with.
void forget_impulses(WorldData& world) {
    forget_joint_impulses(world);
    for (uint32_t i : world.active) {
        ContactRecord& r = world.records[i];
        float sum = r.twist_impulse;
        for (float x : r.normal_impulse) sum += x;
        for (float x : r.friction_impulse) sum += x;
        if (!is_finite(sum)) clear_impulses(r);
    }
}

}  // namespace

void unpack_bodies(WorldData& world, float dt, bool forces_end) {
    BodyStore& bodies = world.bodies;
    const Array<uint32_t>& list = world.awake;
    Array<Pose>& start = world.continuous.start;
    const bool watched = world.config.continuous;
    if (watched) start.resize_unset(static_cast<size_t>(world.solver_bodies.count - reserved_bodies));
    std::atomic<int> capped{0}, contained{0};
    world.tasks.for_each(list.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            const uint32_t slot = list[static_cast<size_t>(i)];
            BodyInfo& info = bodies.info[slot];
            const Pose before = bodies.pose[slot];
            if (watched) start[static_cast<size_t>(info.solver_index - reserved_bodies)] = before;
            unpack_body(world, slot, dt);
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
            if (info.capped) capped.fetch_add(1, std::memory_order_relaxed);
            if (info.contained) contained.fetch_add(1, std::memory_order_relaxed);
        }
    });
    world.statistics.capped_bodies = capped.load(std::memory_order_relaxed);
    world.statistics.contained_bodies = contained.load(std::memory_order_relaxed);
    if (world.statistics.contained_bodies > 0) forget_impulses(world);
}

}  // namespace lendulet
