// Which islands take more substeps than the world's setting. A contact that carries R times the weight of its lighter
// body sinks by 2 (leak / bias) R g h^2, and a column of size w and height H under it buckles for R (H / w)^2 g h^2 of
// about w (docs/solver.md); both shrink with the square of the substep. Small islands that need it therefore take 2, 4,
// 8 or 16 times as many substeps, and so do small groups of jointed bodies with loads or loops (joint_groups.cpp);
// large ones, where that would cost, those with other joints and those on bodies that are moved by hand keep to the
// setting.
//
// Reads this step's contacts with their warm-start impulses, which are in units of the world's substep. Leaves the
// active ones with their bodies, and each body's class in `island_loads`.
#include <utility>

#include "base/prefetch.h"
#include "world/first_loads.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int contacts_per_task = 512;
constexpr int most_contacts = 1024;       // of an island, times its multiple of substeps
constexpr float allowed_sinking = 1e-3f;  // of the size of the bodies
constexpr float buckling_reserve = 1.7f;  // above the load at which a column of boxes was seen to buckle
constexpr float resting_speed = 0.5f;     // m/s; what moves faster is no load but an impact
constexpr float kept_reserve = 1.6f;  // a class is left only when fewer substeps would carry this many times the load
constexpr int patience = 60;          // ... for so many steps: a column that has just stiffened springs up a little
constexpr int falling_patience = 12;  // ... and for so many where all bodies are fast, or none carries anything
// Steps for which a load must be felt before an island takes more substeps for it: what lands on bodies that lie still
// presses them for a step or two, and so does what rocks. Of 200 bodies that jump about, two thirds took two or four
// times the substeps with 1, half of them with 2, none with 3.
constexpr int lasting_load = 3;
constexpr int calm_steps = 3;  // that a body must have been slow for: what lands carries many times its weight for one
constexpr float first_reserve = 4.0f;  // of loads that are guessed: what is built at rest shall not begin by swinging

uint32_t root(Array<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

bool moves(const WorldData& world, uint32_t slot) {
    const BodyMomenta& m = world.bodies.momenta[slot];
    return length_squared(m.p) + length_squared(m.L) > 0.0f;
}

// Begins the entry of a dynamic body, anew in every step, with all that its contacts ask of it.
void begin_entry(WorldData& world, uint32_t slot) {
    const BodyStore& bodies = world.bodies;
    IslandLoad& l = world.island_loads[slot];
    const bool known = l.step == world.steps || l.slept;
    const uint8_t before = known ? l.substeps : uint8_t{0}, waited = known ? l.waited : uint8_t{0};
    const uint8_t pressed = known ? l.pressed : uint8_t{0};
    const uint8_t calm = known ? l.calm : uint8_t{0};
    l = {};
    l.step = world.steps + 1;
    l.lowest = l.highest = dot(from_origin(bodies.pose[slot].position), world.config.gravity);
    l.before = before;
    l.waited = waited;
    l.pressed = pressed;
    l.moves = moves(world, slot);
    const bool slow = length_squared(bodies.velocity(slot)) < resting_speed * resting_speed;
    l.calm = !l.moves            ? uint8_t{calm_steps}
             : !slow             ? uint8_t{0}
             : calm < calm_steps ? static_cast<uint8_t>(calm + 1)
                                 : calm;
    l.slow = l.rests = l.calm >= calm_steps;
    l.inverse_mass = bodies.mass[slot].inverse_mass;
    l.radius = bodies.info[slot].radius;
    l.carried = bodies.mass[slot].mass * bodies.info[slot].gravity_factor;
    world.load_parent[slot] = slot;
    world.loaded.push_back(slot);
}

bool has_entry(const WorldData& world, uint32_t slot) { return world.island_loads[slot].step == world.steps + 1; }

// Whether the body moves by constraints in this step; its entry is then there.
bool takes_part(WorldData& world, uint32_t slot) {
    if (has_entry(world, slot)) return true;
    const BodyInfo& info = world.bodies.info[slot];
    if (info.asleep || info.type != BodyType::dynamic) return false;
    begin_entry(world, slot);
    world.island_loads[slot].touches = true;
    return true;
}

// Makes one island of two; returns its root, the smaller slot.
uint32_t join(WorldData& world, uint32_t a, uint32_t b) {
    Array<uint32_t>& parent = world.load_parent;
    a = root(parent, a);
    b = root(parent, b);
    if (a == b) return a;
    if (b < a) std::swap(a, b);
    parent[b] = a;
    IslandLoad &x = world.island_loads[a], &y = world.island_loads[b];
    x.contacts += y.contacts;
    x.sinking = maximum(x.sinking, y.sinking);
    x.buckling = maximum(x.buckling, y.buckling);
    x.felt_sinking = maximum(x.felt_sinking, y.felt_sinking);
    x.felt_buckling = maximum(x.felt_buckling, y.felt_buckling);
    x.lowest = minimum(x.lowest, y.lowest);
    x.highest = maximum(x.highest, y.highest);
    x.least = x.least > y.least ? x.least : y.least;
    x.before = x.before > y.before ? x.before : y.before;
    x.waited = x.waited < y.waited ? x.waited : y.waited;
    x.pressed = x.pressed > y.pressed ? x.pressed : y.pressed;
    x.tied |= y.tied;
    x.rests |= y.rests;
    return a;
}

float impulse_of(const ContactRecord& r) {
    return r.normal_impulse[0] + r.normal_impulse[1] + r.normal_impulse[2] + r.normal_impulse[3];
}

// Adds what a contact carries to its island's loads, unless its bodies are fast. `both` are moving ones.
void count_load(WorldData& world, IslandLoad& island, float impulse, const TouchingBodies& bodies, bool both,
                float weight, bool guessed = false) {
    IslandLoad &a = world.island_loads[bodies.a], &b = world.island_loads[bodies.b];  // that of a static body is unused
    float lightest = b.inverse_mass, radius = b.radius;
    if (both) {
        lightest = maximum(lightest, a.inverse_mass);
        radius = minimum(radius, a.radius);
    }
    // The upper body of a contact that carries is held by it.
    if (both || !bodies.a_above) (bodies.a_above ? a : b).held = true;
    if (!(impulse * lightest > weight) || !b.slow || (both && !a.slow)) return;
    float ratio = (guessed ? first_reserve : 1.0f) * impulse * lightest / weight;
    float size = 1.15f * radius;  // a cube's edge from its diagonal
    float &sinking = guessed ? island.sinking : island.felt_sinking,
          &buckling = guessed ? island.buckling : island.felt_buckling;
    sinking = maximum(sinking, ratio / size);
    buckling = maximum(buckling, ratio / (size * size * size));
}

struct Load {
    float sinking, buckling;
};

// The least class whose substeps carry `times` this load.
int class_for(const IslandLoad& l, Load load, float gravity, float dt, int substeps, float times) {
    float height = (l.highest - l.lowest) / gravity;
    float drop = times * gravity * dt * dt * (contact_leak / contact_bias);
    float needed = drop * maximum((2.0f / allowed_sinking) * load.sinking,
                                  buckling_reserve * load.buckling * height * height);  // square of the substeps
    int c = 0;
    for (float n = static_cast<float>(substeps); c + 1 < substep_classes && n * n < needed; n *= 2.0f) ++c;
    return c;
}

int larger(int a, int b) { return a > b ? a : b; }

// Sets the class of a root: up at once for loads that are known, soon for those that are felt, and down one at a time
// and with patience.
void decide(IslandLoad& l, float gravity, float dt, int substeps) {
    l.decided = true;
    if (l.tied) return;
    int c = l.least;
    if (gravity > 0.0f) {
        int kept = l.before;
        const Load known{l.sinking, l.buckling}, felt{l.felt_sinking, l.felt_buckling};
        const Load all{maximum(known.sinking, felt.sinking), maximum(known.buckling, felt.buckling)};
        c = larger(c, class_for(l, known, gravity, dt, substeps, 1.0f));
        const int asked = class_for(l, felt, gravity, dt, substeps, 1.0f);
        l.pressed = asked > larger(kept, c) ? static_cast<uint8_t>(l.pressed + 1) : uint8_t{0};
        if (l.pressed >= lasting_load) c = asked, l.pressed = 0;
        bool bearable = kept > 0 && class_for(l, all, gravity, dt, substeps, kept_reserve) < kept;
        l.waited = bearable ? static_cast<uint8_t>(l.waited + 1) : uint8_t{0};
        const bool stands = l.rests && all.sinking > 0.0f;
        if (l.waited >= (stands ? patience : falling_patience)) --kept, l.waited = 0;
        c = larger(c, kept);
    }
    while (c > 0 && (l.contacts << c) > most_contacts) --c;
    l.substeps = static_cast<uint8_t>(c);
}

// Awake groups of bodies whose joints need more substeps, each as one island with its contacts.
// Their substeps grow with the step's shortness too: who takes steps of 1/240 s asks for a quarter of the gaps, not for
// the same ones by fewer substeps a step.
void add_joint_groups(WorldData& world, float dt) {
    Array<IslandLoad>& loads = world.island_loads;
    const float sharper = maximum(1.0f, 1.0f / (60.0f * dt));
    for (const JointGroupLoad& g : world.joint_groups) {
        const JointedBody* list = world.jointed_bodies.data() + g.first;
        if (world.bodies.info[list[0].slot].asleep) continue;
        for (int i = 0; i < g.count; ++i) {
            if (!has_entry(world, list[i].slot)) begin_entry(world, list[i].slot);
            loads[list[i].slot].in_group = true;
            join(world, list[0].slot, list[i].slot);
        }
        IslandLoad& l = loads[root(world.load_parent, list[0].slot)];
        l.contacts += g.joints;
        l.sinking = maximum(l.sinking, 0.5f * sharper * g.sinking);
        l.least = g.least > l.least ? g.least : l.least;
    }
}

// Islands with joints of other groups, or joints to kinematic bodies in motion, keep to the setting.
void tie_other_joints(WorldData& world) {
    Array<IslandLoad>& loads = world.island_loads;
    if (world.active.empty() && world.joint_groups.empty()) return;
    auto mark = [&](uint32_t slot, uint32_t other) {
        if (!has_entry(world, slot)) return;
        loads[root(world.load_parent, slot)].tied |=
            !loads[slot].in_group || (world.bodies.info[other].type == BodyType::kinematic && moves(world, other));
    };
    for (uint32_t joint : world.movers.joints) {
        const JointInfo& j = world.joints.info[joint];
        mark(j.body_a, j.body_b), mark(j.body_b, j.body_a);
    }
}

// Whether gravity alone changes how the body moves, as what the narrow phase foresees takes it.
bool moves_freely(const WorldData& world, uint32_t slot) {
    constexpr float most_damping = 1.0f;  // 1/s: within the step what it takes from a way is less than the margin
    const BodyInfo& info = world.bodies.info[slot];
    const bool falls_as_foreseen = info.gravity_factor >= 0.0f && info.gravity_factor <= 1.0f;
    return !info.has_forces && falls_as_foreseen && info.linear_damping <= most_damping &&
           world.joints.first_of(slot) == no_joint_link;
}

// Reads what is asked of the records below, where workers can share it.
void survey_contacts(WorldData& world) {
    world.tasks.for_each(world.touching.count(), contacts_per_task, [&](int begin, int end, int) {
        for (int k = begin; k < end; ++k) {
            const auto i = static_cast<size_t>(k);
            if (i + prefetch_distance < world.touching.size())
                prefetch<3>(&world.records[world.touching[i + prefetch_distance]]);
            const ContactRecord& r = world.records[world.touching[i]];
            TouchingBodies& t = world.touching_bodies[i];
            t.impulse = impulse_of(r);
            t.a_above = dot(Vec3{r.normal[0], r.normal[1], r.normal[2]}, world.config.gravity) > 0.0f;
            t.bounces = r.restitution > 0.0f || (r.flags & contact_swift) != 0;
            t.passes =
                t.bounces && (r.flags & contact_passes) != 0 && moves_freely(world, t.a) && moves_freely(world, t.b);
            t.kind = contact_kind(r);
        }
    });
}

// Whether the body can take a step as a whole, exactly: it falls without drag, and turns about one axis or by a closed
// form (see turn.inl), or does not turn to speak of.
bool goes_alone(const WorldData& world, uint32_t slot, float dt) {
    constexpr float still = 1e-3f,
                    most_turn = 64.0f;  // rad in a step, times the anisotropy; half of what long turns go to
    const BodyInfo& info = world.bodies.info[slot];
    const BodyMass& mass = world.bodies.mass[slot];
    if (info.type != BodyType::dynamic || info.has_forces || world.joints.first_of(slot) != no_joint_link) return false;
    if (info.linear_damping > 0.0f || info.angular_damping > 0.0f) return false;
    const float turn = dt * length(world.bodies.angular_velocity(slot)) * mass.anisotropy;
    return turn < still || (turn < most_turn && (mass.round() || mass.symmetric()));
}

}  // namespace

void choose_substeps(WorldData& world, float dt) {
    Array<IslandLoad>& loads = world.island_loads;
    loads.resize(world.bodies.slots.capacity());
    world.load_parent.resize_unset(loads.size());
    world.loaded.reserve(loads.size());
    const float gravity = length(world.config.gravity);
    const float weight = gravity * dt / static_cast<float>(world.config.solver_steps);
    world.active.clear();
    world.active_bodies.clear();
    world.first_loads.clear();
    world.loaded.clear();
    survey_contacts(world);
    const size_t count = world.touching.size();
    for (size_t k = 0; k < count; ++k) {
        const TouchingBodies bodies = world.touching_bodies[k];
        const uint32_t i = world.touching[k], a = bodies.a, b = bodies.b;
        if (!takes_part(world, b)) continue;  // B moves wherever one of them does, and islands wake as one
        world.active.push_back(i);
        world.active_bodies.push_back(bodies);
        const bool both = !bodies.fixed_a && takes_part(world, a);
        if (both) loads[a].meets_moving = loads[b].meets_moving = true;
        IslandLoad& island = loads[both ? join(world, a, b) : root(world.load_parent, b)];
        ++island.contacts;
        island.tied |= !both && world.bodies.info[a].type == BodyType::kinematic && moves(world, a);
        if (bodies.impulse > 0.0f) count_load(world, island, bodies.impulse, bodies, both, weight);
        else if (!loads[b].moves && !moves(world, a)) offer_first_load(world, i, bodies, both);
    }
    if (!world.first_loads.empty()) {
        guess_first_loads(world, weight);
        for (const FirstLoad& f : world.first_loads) {
            IslandLoad& island = loads[root(world.load_parent, f.bodies.b)];
            const float impulse = impulse_of(world.records[f.record]);
            count_load(world, island, impulse, f.bodies, f.lower != no_slot, weight, true);
        }
    }
    add_joint_groups(world, dt);
    tie_other_joints(world);
    for (uint32_t slot : world.loaded) {
        IslandLoad& l = loads[root(world.load_parent, slot)];
        if (!l.decided) decide(l, gravity, dt, world.config.solver_steps);
    }
    if (!world.first_loads.empty()) settle_first_loads(world, dt);
}

int substep_class(WorldData& world, uint32_t slot, float dt) {
    if (slot >= world.island_loads.size() || !has_entry(world, slot))
        return goes_alone(world, slot, dt) ? alone_class : 0;
    IslandLoad& l = world.island_loads[slot];
    const IslandLoad& island = world.island_loads[root(world.load_parent, slot)];
    l.substeps = island.substeps;
    l.waited = island.waited;
    l.pressed = island.pressed;
    return l.substeps;
}

}  // namespace lendulet
