// After the solver: bodies must not have passed through anything.
//
// The solver's contacts reach ahead, so most fast bodies are stopped where they should be. What it lets through are
// shapes that turn far within a step, thin meshes of many triangles, and bodies thrown at a wall by a contact of the
// same step. All of these show in the same way: the inner core of a shape (geometry.h) reaches a surface that it was
// clear of. Shapes that merely rest, slide or sink a little never do, so that this test disturbs no contact.
//
// A body is looked at only where some point of it moved farther than its shallowest core is deep. Where its core is
// found to meet something, the whole shape's time of impact with that is taken, or the core's where the shapes
// overlapped to begin with; the body is put where it was then, as the other body carried it on to the end of the step.
// Momenta are left alone (but see keep_energy): the next step finds the contact and solves it as every other.
#include "world/continuous.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "world/continuous_path.h"

namespace lendulet {
namespace {

constexpr int suspects_per_task = 4, bodies_per_task = 256;
constexpr uint8_t fast_kinematic = 2;  // of ContinuousData::is_suspect, while suspects are sought
// A body that turns farther within a step, rad, has contacts too rough to trust with its energy: a slender rod at 300
// rad/s and 240 Hz would gain a fifth of it where it hits a pole.
constexpr float rough_turn = 0.25f;

bool may_meet(const WorldData& world, uint32_t a, uint32_t b) {
    const ColliderInfo &ca = world.colliders.info[a], &cb = world.colliders.info[b];
    return ca.body != cb.body && !ca.is_trigger && !cb.is_trigger && filters_match(ca.filter, cb.filter) &&
           !world.joints.keeps_apart(ca.body, cb.body);
}

// What a body met first.
struct Impact {
    double fraction = 2.0;
    uint32_t mine = no_slot, other = no_slot;  // colliders
    void offer(double t, uint32_t a, uint32_t b) {
        if (t < fraction || (t == fraction && (b < other || (b == other && a < mine))))
            fraction = t, mine = a, other = b;
    }
};

void meet(const WorldData& world, uint32_t mine, const BodyPath& path, uint32_t other, const BodyPath& other_path,
          Impact& impact) {
    Position origin = path.start.position;
    const Geometry &a = world.colliders.geometry[other], &b = world.colliders.geometry[mine];
    Motion motion_a = motion_of(world, other, other_path, origin), motion_b = motion_of(world, mine, path, origin);
    CastHit deep, first;
    double limit = minimum(impact.fraction, 1.0);
    if (!cast_shapes(a, motion_a, inner_core(b).geometry, motion_b, limit, deep, true)) return;
    // A shape that lay against the other to begin with is left to the solver until its core is about to pass.
    constexpr double at_once = 1e-3;
    bool touching = !cast_shapes(a, motion_a, b, motion_b, deep.fraction, first) || first.fraction < at_once;
    impact.offer(touching ? deep.fraction : first.fraction, mine, other);
}

// Bounds of everything that a body passes between two places.
void bounds_of(Position from, Position to, float radius, float lower[3], float upper[3]) {
    Vec3 r{radius, radius, radius};
    Vec3 a = from_origin(from), b = from_origin(to);
    Vec3 low = minimum(a, b) - r, high = maximum(a, b) + r;
    for (int k = 0; k < 3; ++k) lower[k] = component(low, k), upper[k] = component(high, k);
}

bool is_obstacle(const WorldData& world, uint32_t collider) {
    return world.colliders.info[collider].boxed &&
           world.bodies.info[world.colliders.info[collider].body].type != BodyType::dynamic;
}

// Those that nothing can push, unless they are many.
void find_obstacles(WorldData& world) {
    constexpr size_t few = 48;
    ContinuousData& c = world.continuous;
    c.colliders_changed = false;
    c.obstacle_slots.clear();
    for (uint32_t slot : world.colliders.slots.order()) {
        const ColliderInfo& info = world.colliders.info[slot];
        if (world.bodies.info[info.body].type == BodyType::dynamic) continue;
        if (info.boxed) c.obstacle_slots.push_back(slot);
        else c.colliders_changed = true;  // until it has
        if (c.obstacle_slots.size() > few) return c.obstacle_slots.clear();
    }
    std::sort(c.obstacle_slots.begin(), c.obstacle_slots.end());  // order: total
}

// Lists what nothing can push, if that is worth while.
void list_obstacles(WorldData& world, float dt) {
    ContinuousData& c = world.continuous;
    c.obstacles.clear();
    c.obstacle_boxes.clear();
    if (c.suspects.count() * 8 <= world.colliders.slots.count()) return;
    if (c.colliders_changed) find_obstacles(world);
    for (uint32_t slot : c.obstacle_slots) {
        const uint32_t body = world.colliders.info[slot].body;
        const bool known = !c.obstacles.empty() && c.obstacles.back().carrier.body == body;
        const Carrier carrier = known ? c.obstacles.back().carrier : carrier_of(world, body, path_of(world, body, dt));
        const int lane = c.obstacles.count() % block_size;
        if (lane == 0) c.obstacle_boxes.push_back({}), clear_lanes(c.obstacle_boxes.back());
        const BroadBox& box = box_of(world, slot);
        set_lane(c.obstacle_boxes.back(), lane, box.lower, box.upper);
        c.obstacles.push_back({slot, carrier});
    }
}

// A body on its way: how it turned is found when something is near enough to ask.
class Suspect {
public:
    Suspect(const WorldData& world, uint32_t body, float dt) : world_(world), body_(body), dt_(dt) {}
    const BodyPath& path() {
        if (!known_) path_ = path_of(world_, body_, dt_);
        known_ = true;
        return path_;
    }
    // The first impact with obstacles, or with other bodies. `near`: room for those that are near.
    Impact first_impact(bool obstacles, Array<uint32_t>& near) {
        const ContinuousData& c = world_.continuous;
        const BodyInfo& info = world_.bodies.info[body_];
        float lower[3], upper[3];
        bounds_of(c.start[place_of(world_, body_)].position, world_.bodies.pose[body_].position, info.radius, lower,
                  upper);
        if (obstacles && !c.obstacles.empty()) meet_listed(lower, upper);
        else meet_found(lower, upper, obstacles, near);
        return impact_;
    }

private:
    // Of the obstacles on the list, those whose boxes are near. What lies in a drum that turns goes along with all of
    // its sides, which is asked but once.
    void meet_listed(const float lower[3], const float upper[3]) {
        const ContinuousData& c = world_.continuous;
        const WideBox box = spread(lower, upper);
        const Obstacle* obstacle = c.obstacles.data();
        for (const BoxBlock& block : c.obstacle_boxes) {
            for (uint32_t near = overlaps(block, box); near;) {
                const Obstacle& o = obstacle[take_bit(near)];
                if (moved_far(o.carrier)) meet_collider(o.collider, o.carrier.path);
            }
            obstacle += block_size;
        }
    }
    // Those that the broad phase finds: obstacles or others, rising.
    void meet_found(const float lower[3], const float upper[3], bool obstacles, Array<uint32_t>& near) {
        near.clear();
        world_.broad_phase.query_box(lower, upper, near);
        std::sort(near.begin(), near.end());  // order: total
        for (uint32_t i : near) {
            if (!world_.colliders.info[i].boxed || is_obstacle(world_, i) != obstacles) continue;
            const uint32_t carrier = world_.colliders.info[i].body;
            const BodyPath other = path_of(world_, carrier, dt_);
            if (!obstacles || moved_far(carrier_of(world_, carrier, other))) meet_collider(i, other);
        }
    }
    // Whether, as the carrier of an obstacle saw it, the body moved so far that it may have passed through it.
    bool moved_far(const Carrier& carrier) {
        if (carrier.still) return true;
        if (carrier.body != asked_) {
            asked_ = carrier.body;
            far_ = most_reach_against(world_, body_, carrier, dt_) > world_.bodies.info[body_].depth;
        }
        return far_;
    }
    void meet_collider(uint32_t other, const BodyPath& other_path) {
        for (uint32_t c = world_.bodies.info[body_].first_collider; c != no_slot; c = world_.colliders.info[c].next)
            if (may_meet(world_, c, other)) meet(world_, c, path(), other, other_path, impact_);
    }

    const WorldData& world_;
    uint32_t body_;
    float dt_;
    bool known_ = false, far_ = false;
    uint32_t asked_ = no_slot;  // the carrier that far_ is of
    BodyPath path_;
    Impact impact_;
};

// A body that is put from one orientation of its path to another keeps its angular momentum. The path is an even turn,
// the true motion need not be: a slender body may have many times its energy there. It keeps that too where it is
// turned by the little that the path is off, so that L lies in the body as it did; otherwise L is cut to the energy.
void keep_energy(BodyStore& bodies, uint32_t body, Quat from) {
    Vec3& L = bodies.momenta[body].L;
    Quat& pose = bodies.pose[body].orientation;
    Vec3 direction = normalize(L), in_body = rotate(pose, rotate_inverse(from, direction));
    if (dot(in_body, direction) > 0.995f) {
        pose = normalize(rotation_between(in_body, direction) * pose);
        return;
    }
    const Quat to = pose;
    pose = from;
    float before = dot(L, bodies.angular_velocity(body));
    pose = to;
    float after = dot(L, bodies.angular_velocity(body));
    if (after > before) L = square_root(maximum(before, 0.0f) / after) * L;
}

// Puts the body where it was at the impact, carried on by what it met.
void stop(WorldData& world, uint32_t body, const BodyPath& path, const Impact& impact, float dt) {
    BodyPath carrier = path_of(world, world.colliders.info[impact.other].body, dt);
    Pose then = pose_at(path, impact.fraction), carrier_then = pose_at(carrier, impact.fraction);
    Vec3 arm = rotate_inverse(carrier_then.orientation, then.position - carrier_then.position);
    Pose& pose = world.bodies.pose[body];
    if (is_still(world, world.colliders.info[impact.other].body)) {
        pose = then;
    } else {
        pose.position = carrier.end.position + rotate(carrier.end.orientation, arm);
        pose.orientation = normalize(carrier.end.orientation * conjugate(carrier_then.orientation) * then.orientation);
    }
    world.bodies.momenta[body].x_low = world.bodies.momenta[body].turn_low = {};
    keep_energy(world.bodies, body, path.end.orientation);
    BodyInfo& info = world.bodies.info[body];
    info.stopped = true;
    world.continuous.fraction[place_of(world, body)] *= static_cast<float>(impact.fraction);
}

// Bodies in the way of kinematic ones that moved far, and far against them.
void suspect_swept(WorldData& world, uint32_t kinematic, const BodyPath& path, float dt, Array<uint32_t>& near) {
    float lower[3], upper[3];
    bounds_of(path.start.position, path.end.position, world.bodies.info[kinematic].radius, lower, upper);
    const Carrier carrier = carrier_of(world, kinematic, path);
    near.clear();
    world.broad_phase.query_box(lower, upper, near);
    auto suspect = [&](uint32_t body) {
        const BodyInfo& info = world.bodies.info[body];
        if (info.type != BodyType::dynamic || is_still(world, body) || info.contained) return;
        std::atomic_ref<uint8_t> mark(world.continuous.is_suspect[place_of(world, body)]);
        if (mark.load(std::memory_order_relaxed) == 0 && most_reach_against(world, body, carrier, dt) > info.depth)
            mark.store(1, std::memory_order_relaxed);
    };
    world.tasks.for_each(near.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) suspect(world.colliders.info[near[static_cast<size_t>(i)]].body);
    });
}

void find_suspects(WorldData& world, float dt) {
    ContinuousData& c = world.continuous;
    c.suspects.clear();
    c.bullets.clear();
    c.is_suspect.assign(c.start.size(), 0);
    c.fraction.assign(c.start.size(), 1.0f);
    std::atomic<bool> any{false};
    world.tasks.for_each(world.awake.count(), bodies_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            const uint32_t body = world.awake[static_cast<size_t>(i)];
            BodyInfo& info = world.bodies.info[body];
            info.stopped = false;
            if (info.contained || !(most_reach_of(world, body, dt) > info.depth)) continue;
            const float way = length(world.bodies.pose[body].position - c.start[place_of(world, body)].position);
            if (!(way > info.depth) && !(reach_of(path_of(world, body, dt), info.radius) > info.depth)) continue;
            c.is_suspect[place_of(world, body)] = info.type == BodyType::kinematic ? fast_kinematic : 1;
            any.store(true, std::memory_order_relaxed);
        }
    });
    if (!any.load(std::memory_order_relaxed)) return;
    for (uint32_t body : world.awake) {
        uint8_t& mark = c.is_suspect[place_of(world, body)];
        if (mark != fast_kinematic) continue;
        mark = 0;
        suspect_swept(world, body, path_of(world, body, dt), dt, c.near[0]);
    }
    for (uint32_t body : world.awake) {
        const BodyInfo& info = world.bodies.info[body];
        if (!c.is_suspect[place_of(world, body)] || info.contained) continue;
        c.suspects.push_back(body);
        if (info.bullet) c.bullets.push_back(body);
    }
}

// --- energy

float kinetic_energy(const BodyMass& mass, Quat orientation, Vec3 v, Vec3 w) {
    Vec3 spin = rotate_inverse(orientation, w);
    return 0.5f * (mass.mass * dot(v, v) + dot(multiply(mass.inertia, spin), spin));
}

// Contacts of a body that turns far within a step are rough: their points go round before they are solved. Against
// things that do not move such a body must not gain energy, and is slowed where it would.
void limit_energy(WorldData& world, uint32_t body, const BodyPath& path) {
    BodyStore& bodies = world.bodies;
    const BodyMass& mass = bodies.mass[body];
    const BodyStart& start = world.solver_bodies.start[static_cast<size_t>(bodies.info[body].solver_index)];
    BodyMomenta& m = bodies.momenta[body];
    const float* a = world.solver_bodies.motion[static_cast<size_t>(bodies.info[body].solver_index)].acceleration;
    Vec3 force = mass.mass * Vec3{a[0], a[1], a[2]};
    float allowed = kinetic_energy(mass, path.start.orientation, {start.v[0], start.v[1], start.v[2]},
                                   {start.w[0], start.w[1], start.w[2]}) +
                    maximum(0.0f, dot(force, path.end.position - path.start.position));
    float now =
        kinetic_energy(mass, bodies.pose[body].orientation, bodies.velocity(body), bodies.angular_velocity(body));
    if (!(now > allowed)) return;
    float scale = square_root(allowed / now);
    m.p = scale * m.p, m.p_low = {}, m.L = scale * m.L;
}

// Whether the surfaces of a contact run over their bodies, and so may give these energy.
bool is_driven(const WorldData& world, uint32_t record) {
    if (!world.has_extras) return false;
    const float* v = world.extras[record].running;
    return v[0] != 0.0f || v[1] != 0.0f || v[2] != 0.0f;
}

// For the suspects that turned far, by the spin before the step or after it, touch something and touch nothing that
// moves or runs.
void limit_energies(WorldData& world, float dt) {
    ContinuousData& c = world.continuous;
    bool any = false;
    for (uint32_t body : c.suspects) {
        const float* w = world.solver_bodies.start[place_of(world, body) + reserved_bodies].w;
        float before = length(Vec3{w[0], w[1], w[2]}), after = length(world.bodies.angular_velocity(body));
        bool far = dt * maximum(before, after) > rough_turn;
        c.is_suspect[place_of(world, body)] = far ? 2 : 1;
        any = any || far;
    }
    if (!any) return;
    for (size_t i = 0; i < world.active_ends.size(); ++i) {
        const ContactEnds& e = world.active_ends[i];
        const bool both = e.a >= reserved_bodies && e.b >= reserved_bodies;
        if (!both && !is_driven(world, world.active[i])) continue;
        for (int32_t body : {e.a, e.b})
            if (body >= reserved_bodies) c.is_suspect[static_cast<size_t>(body - reserved_bodies)] = 1;
    }
    for (uint32_t body : c.suspects) {
        const size_t place = place_of(world, body);
        const BodyMotion& motion = world.solver_bodies.motion[place + reserved_bodies];
        bool driven = motion.torque[0] != 0.0f || motion.torque[1] != 0.0f || motion.torque[2] != 0.0f;
        bool left_alone = motion.free > 0.0f || motion.joints > 0.0f || driven;
        if (c.is_suspect[place] == 2 && !left_alone) limit_energy(world, body, path_of(world, body, dt));
    }
}

}  // namespace

void stop_at_impacts(WorldData& world, float dt) {
    world.statistics.stopped_bodies = 0;
    if (!world.config.continuous) return;
    find_suspects(world, dt);
    ContinuousData& c = world.continuous;
    list_obstacles(world, dt);
    // Task code takes no memory: the lists that it fills have room for all that it may find.
    for (Array<uint32_t>& near : c.near)
        if (c.obstacles.empty() && !c.suspects.empty())
            near.reserve(static_cast<size_t>(world.colliders.slots.count()));
    // Against what nothing can push: each body for itself.
    world.tasks.for_each(c.suspects.count(), suspects_per_task, [&](int begin, int end, int worker) {
        for (int i = begin; i < end; ++i) {
            const uint32_t body = c.suspects[static_cast<size_t>(i)];
            Suspect suspect(world, body, dt);
            const Impact impact = suspect.first_impact(true, c.near[static_cast<size_t>(worker)]);
            if (impact.fraction <= 1.0) stop(world, body, suspect.path(), impact, dt);
        }
    });
    // Bullets against other bodies as these now move, one after the other.
    for (uint32_t body : c.bullets) {
        Suspect suspect(world, body, dt);
        const Impact impact = suspect.first_impact(false, c.near[0]);
        if (impact.fraction <= 1.0) stop(world, body, suspect.path(), impact, dt);
    }
    limit_energies(world, dt);
    for (uint32_t body : c.suspects) world.statistics.stopped_bodies += world.bodies.info[body].stopped;
}

}  // namespace lendulet
