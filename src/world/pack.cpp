// Stages 5 and 7: awake bodies and their contacts into the solver's packed arrays, and back.
#include <algorithm>
#include <atomic>

#include "base/prefetch.h"
#include "dynamics/free_flight.h"
#include "math/decay.h"
#include "math/kept_sum.h"
#include "world/narrow/manifold_records.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int bodies_per_task = 256, contacts_per_task = 512;

// How many substeps of its own a body takes in one of the setting. What is kept from step to step, impulses and
// changes, is in units of the setting's substep.
float multiple(const WorldData& world, int32_t solver_body) {
    if (solver_body >= world.alone.begin) return 1.0f / static_cast<float>(world.config.solver_steps);
    int c = 0;
    while (solver_body >= world.parts[c].bodies.end) ++c;
    return substep_multiple(c);
}

// As BodyMotion::free.
float freedom(const WorldData& world, uint32_t slot) {
    if (slot >= world.island_loads.size()) return 1.0f;
    const IslandLoad& l = world.island_loads[slot];
    if (l.step != world.steps + 1 || !l.touches) return 1.0f;
    if (!l.meets_moving) return 0.0f;
    return l.meets_fixed ? -2.0f : -1.0f;
}

// What gravity and applied forces do to a body, before damping.
struct Push {
    Vec3 acceleration, torque;
};
Push push_on(const WorldData& world, uint32_t slot, Vec3 plain_gravity, float dt) {
    const BodyInfo& info = world.bodies.info[slot];
    if (!info.has_forces && info.gravity_factor == 1.0f) return {plain_gravity, {}};
    return {acceleration(world, slot, dt), torque(world, slot, dt)};
}
// The acceleration of a body on which gravity acts as it is and nothing else.
Vec3 plain_gravity(const WorldData& world, float dt) { return limited(world.config.gravity, 2.0f * max_speed / dt); }

void put(float (*p)[body_batch], int i, Vec3 v) { p[0][i] = v.x, p[1][i] = v.y, p[2][i] = v.z; }

void set_lane(PackBatch& batch, int i, const WorldData& world, uint32_t slot, Vec3 gravity, float dt) {
    const BodyInfo& info = world.bodies.info[slot];
    const bool dynamic = info.type == BodyType::dynamic;
    const float share = 1.0f / multiple(world, info.solver_index);
    batch.body[i] = static_cast<int32_t>(slot);
    batch.place[i] = info.solver_index;
    batch.dynamic[i] = dynamic ? 1.0f : 0.0f;
    batch.share[i] = share;
    batch.free[i] = dynamic ? freedom(world, slot) : 1.0f;
    Decay linear{0.0f, 1.0f}, angular{0.0f, 1.0f};
    Push push{};
    if (dynamic) {
        push = push_on(world, slot, gravity, dt);
        const float h = share * dt / static_cast<float>(world.config.solver_steps);
        if (info.linear_damping > 0.0f) linear = decay(info.linear_damping, h);
        if (info.angular_damping > 0.0f) angular = decay(info.angular_damping, h);
    }
    batch.linear_loss[i] = linear.loss;
    batch.angular_loss[i] = angular.loss;
    put(batch.acceleration, i, linear.mean * push.acceleration);
    put(batch.torque, i, angular.mean * push.torque);
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
    Vec3 x = from_origin(bodies.pose[slot].position);
    add_kept(x, momenta.x_low, s.x);
    bodies.pose[slot].position = at(x);
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
    int counts[2 * solver_parts] = {}, first = 0;
    auto class_of = [&](const ContactEnds& e) {
        int c = 0;
        while (e.b >= world.parts[c].bodies.end) ++c;
        return c;
    };
    const bool sorts = world.hard_bodies + world.flowing_bodies > 0;
    auto list_of = [&](const ContactEnds& e) { return 2 * (sorts ? class_of(e) : 0) + e.passes; };
    for (const ContactEnds& e : world.active_ends) ++counts[list_of(e)];
    for (int c = 0; c < solver_parts; ++c) {
        SolverPart& part = world.parts[c];
        part.first_contact = first;
        part.row_count = counts[2 * c];
        part.contact_count = counts[2 * c] + counts[2 * c + 1];
        counts[2 * c] = first, counts[2 * c + 1] = first + part.row_count;
        first += part.contact_count;
    }
    for (const SolverPart& part : world.parts)
        if (part.row_count == first) return;
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

void set_lane(UnpackBatch& batch, int i, const WorldData& world, uint32_t slot, Vec3 gravity, float dt) {
    const BodyInfo& info = world.bodies.info[slot];
    const bool dynamic = info.type == BodyType::dynamic;
    batch.body[i] = static_cast<int32_t>(slot);
    batch.place[i] = info.solver_index;
    batch.dynamic[i] = dynamic ? 1.0f : 0.0f;
    batch.substeps[i] = multiple(world, info.solver_index);
    Vec3 gain;
    batch.loss[i] = 0.0f;
    if (dynamic && world.solver_bodies.motion[static_cast<size_t>(info.solver_index)].free > 0.0f) {
        const Decay whole = decay(info.linear_damping, dt);
        gain = (whole.mean * dt * world.bodies.mass[slot].mass) * push_on(world, slot, gravity, dt).acceleration;
        batch.loss[i] = whole.loss;
    }
    put(batch.gain, i, gain);
}

// Cuts a speed that may be too large, and tells whether the body's state is finite.
void examine(WorldData& world, uint32_t slot) {
    BodyStore& bodies = world.bodies;
    BodyInfo& info = bodies.info[slot];
    info.capped |= info.type == BodyType::dynamic && cap_speed(bodies, slot);
    const BodyMomenta& m = bodies.momenta[slot];
    const Pose& pose = bodies.pose[slot];
    info.contained = !(is_finite(from_origin(pose.position)) && is_finite(m.p) && is_finite(m.L) &&
                       dot(pose.orientation, pose.orientation) < 2.0f);
}

}  // namespace

void pack_bodies(WorldData& world, float dt) {
    const Array<uint32_t>& list = world.awake;
    const Vec3 gravity = plain_gravity(world, dt);
    world.tasks.for_each(list.count(), bodies_per_task, [&](int begin, int end, int) {
        PackBatch batch;
        batch.bodies = columns(world.bodies);
        batch.packed = &world.solver_bodies;
        for_each_batch(begin, end, [&](int first, int count) {
            const uint32_t* slots = list.data() + first;
            batch.count = count;
            for (int i = 0; i < filled(count); ++i)
                set_lane(batch, i, world, slots[std::min(i, count - 1)], gravity, dt);
            world.body_kernels.pack(batch);
        });
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
            const bool crowded = is_crowded(world, t), idle = t.impulse == 0.0f;
            ends[i] = {place_of(t.a), place_of(t.b), t.kind, t.fixed_a, t.bounces, t.held, crowded, idle, t.passes};
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
            if (ends[i].bounces) r.flags = ends[i].crowded ? r.flags | contact_crowded : r.flags & ~contact_crowded;
        }
    });
}

namespace {

// Whether a body goes by the chosen reference integrator: nothing constrains it.
bool flies(const WorldData& world, uint32_t slot) {
    const BodyInfo& info = world.bodies.info[slot];
    return world.config.integrator != Integrator::momentum && info.type == BodyType::dynamic &&
           world.solver_bodies.motion[static_cast<size_t>(info.solver_index)].free > 0.0f;
}

// At most body_batch bodies.
void unpack_batch(WorldData& world, const uint32_t* slots, int count, Vec3 gravity, float dt, UnpackBatch& batch) {
    BodyStore& bodies = world.bodies;
    batch.count = count;
    for (int i = 0; i < filled(count); ++i) set_lane(batch, i, world, slots[std::min(i, count - 1)], gravity, dt);
    BodyMomenta momenta[body_batch];
    BodyChange changes[body_batch];
    for (int i = 0; i < count; ++i)
        if (flies(world, slots[i])) momenta[i] = bodies.momenta[slots[i]], changes[i] = bodies.change[slots[i]];
    world.body_kernels.unpack(batch);
    for (int i = 0; i < count; ++i) {
        const uint32_t slot = slots[i];
        bodies.info[slot].contained = false;
        const bool flown = flies(world, slot);
        if (!flown && !(batch.doubtful[i] > 0.0f)) continue;
        if (flown) {
            bodies.pose[slot] = batch.before[batch.place[i] - reserved_bodies];
            bodies.momenta[slot] = momenta[i], bodies.change[slot] = changes[i];
            fly(world, slot, dt);
        }
        examine(world, slot);
    }
}

}  // namespace

void unpack_bodies(WorldData& world, float dt, bool forces_end) {
    BodyStore& bodies = world.bodies;
    const Array<uint32_t>& list = world.awake;
    Array<Pose>& start = world.continuous.start;
    start.resize_unset(static_cast<size_t>(world.solver_bodies.count - reserved_bodies));
    const Vec3 gravity = plain_gravity(world, dt);
    std::atomic<int> capped{0};
    std::atomic<bool> any_contained{false};
    world.tasks.for_each(list.count(), bodies_per_task, [&](int begin, int end, int) {
        UnpackBatch batch;
        batch.bodies = columns(bodies);
        batch.packed = &world.solver_bodies;
        batch.before = start.data();
        batch.most_speed = max_speed, batch.most_spin = max_angular_speed;
        for_each_batch(begin, end, [&](int first, int count) {
            unpack_batch(world, list.data() + first, count, gravity, dt, batch);
        });
        for (int i = begin; i < end; ++i) {
            const uint32_t slot = list[static_cast<size_t>(i)];
            BodyInfo& info = bodies.info[slot];
            if (forces_end && info.has_forces) bodies.forces[slot] = {}, info.has_forces = false;
            if (info.capped) capped.fetch_add(1, std::memory_order_relaxed);
            if (info.contained) any_contained.store(true, std::memory_order_relaxed);
        }
    });
    world.statistics.capped_bodies = capped.load(std::memory_order_relaxed);
    world.statistics.contained_bodies = 0;
    if (any_contained.load(std::memory_order_relaxed)) contain_islands(world);
}

}  // namespace lendulet
