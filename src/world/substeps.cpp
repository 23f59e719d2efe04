// Which islands take more substeps than the world's setting. A contact that carries R times the weight of its lighter
// body sinks by 2 (leak / bias) R g h^2, and a column of size w and height H under it buckles for R (H / w)^2 g h^2 of
// about w (docs/solver.md); both shrink with the square of the substep. Small islands that need it therefore take 2, 4,
// 8 or 16 times as many substeps, and so do small groups of jointed bodies with loads or loops (joint_groups.cpp);
// large ones, where that would cost, those with other joints and those on bodies that are moved by hand keep to the
// setting.
//
// Reads this step's contacts with their warm-start impulses, which are in units of the world's substep. Leaves the
// bodies' slots in the records, and each body's class in `island_loads`.
#include <utility>

#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int most_contacts = 1024;       // of an island, times its multiple of substeps
constexpr float allowed_sinking = 1e-3f;  // of the size of the bodies
constexpr float buckling_reserve = 1.7f;  // above the load at which a column of boxes was seen to buckle
constexpr float resting_speed = 0.5f;     // m/s; what moves faster is no load but an impact
constexpr float kept_reserve = 1.6f;   // a class is left only when fewer substeps would carry this many times the load
constexpr float first_reserve = 4.0f;  // of loads that are guessed: what is built at rest shall not begin by swinging
constexpr int patience = 60;           // ... for so many steps: a column that has just stiffened springs up a little

uint32_t root(Array<IslandLoad>& loads, uint32_t i) {
    while (loads[i].parent != i) {
        loads[i].parent = loads[loads[i].parent].parent;
        i = loads[i].parent;
    }
    return i;
}

// Begins the entry of a dynamic body, anew in every step.
void entry(WorldData& world, uint32_t slot) {
    IslandLoad& l = world.island_loads[slot];
    if (l.step == world.steps + 1) return;
    float height = dot(from_origin(world.bodies.pose[slot].position), world.config.gravity);
    bool known = l.step == world.steps || l.slept;
    l = {world.steps + 1,
         slot,
         0,
         0.0f,
         0.0f,
         height,
         height,
         0,
         known ? l.substeps : uint8_t{0},
         known ? l.waited : uint8_t{0},
         0,
         false,
         false,
         false,
         false,
         false,
         world.bodies.mass[slot].mass * world.bodies.info[slot].gravity_factor};
}

void join(Array<IslandLoad>& loads, uint32_t a, uint32_t b) {
    a = root(loads, a);
    b = root(loads, b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    IslandLoad &x = loads[a], &y = loads[b];
    y.parent = a;
    x.contacts += y.contacts;
    x.sinking = maximum(x.sinking, y.sinking);
    x.buckling = maximum(x.buckling, y.buckling);
    x.lowest = minimum(x.lowest, y.lowest);
    x.highest = maximum(x.highest, y.highest);
    x.least = x.least > y.least ? x.least : y.least;
    x.before = x.before > y.before ? x.before : y.before;
    x.waited = x.waited < y.waited ? x.waited : y.waited;
    x.tied |= y.tied;
}

bool moves(const WorldData& world, uint32_t slot) {
    const BodyMomenta& m = world.bodies.momenta[slot];
    return length_squared(m.p) + length_squared(m.L) > 0.0f;
}

float impulse_of(const ContactRecord& r) {
    return r.normal_impulse[0] + r.normal_impulse[1] + r.normal_impulse[2] + r.normal_impulse[3];
}

// Adds what a contact carries to its island's loads, unless its bodies are fast. `both` are moving ones.
void count_load(WorldData& world, const ContactRecord& r, float weight, bool both, float reserve = 1.0f) {
    const BodyStore& bodies = world.bodies;
    auto a = static_cast<uint32_t>(r.body_a), b = static_cast<uint32_t>(r.body_b);
    auto slow = [&](uint32_t slot) { return length_squared(bodies.velocity(slot)) < resting_speed * resting_speed; };
    float lightest = bodies.mass[b].inverse_mass, radius = bodies.info[b].radius, impulse = impulse_of(r);
    if (both) {
        lightest = maximum(lightest, bodies.mass[a].inverse_mass);
        radius = minimum(radius, bodies.info[a].radius);
    }
    // The upper body of a contact that carries is held by it.
    bool a_above = dot(Vec3{r.normal[0], r.normal[1], r.normal[2]}, world.config.gravity) > 0.0f;
    if (both || !a_above) world.island_loads[a_above ? a : b].held = true;
    if (!(impulse * lightest > weight) || !slow(b) || (both && !slow(a))) return;
    float ratio = reserve * impulse * lightest / weight, size = 1.15f * radius;  // a cube's edge from its diagonal
    IslandLoad& l = world.island_loads[root(world.island_loads, b)];
    l.sinking = maximum(l.sinking, ratio / size);
    l.buckling = maximum(l.buckling, ratio / (size * size * size));
}

// The least class whose substeps carry `load` times the island's loads.
int class_for(const IslandLoad& l, float gravity, float dt, int substeps, float load) {
    float height = (l.highest - l.lowest) / gravity;
    float drop = load * gravity * dt * dt * (contact_leak / contact_bias);
    float needed = drop * maximum((2.0f / allowed_sinking) * l.sinking,
                                  buckling_reserve * l.buckling * height * height);  // square of the substeps
    int c = 0;
    for (float n = static_cast<float>(substeps); c + 1 < substep_classes && n * n < needed; n *= 2.0f) ++c;
    return c;
}

int larger(int a, int b) { return a > b ? a : b; }

// Sets the class of a root: up at once, down one at a time and with patience.
void decide(IslandLoad& l, float gravity, float dt, int substeps) {
    l.decided = true;
    if (l.tied) return;
    int c = l.least;
    if (gravity > 0.0f) {
        int kept = l.before;
        c = larger(c, class_for(l, gravity, dt, substeps, 1.0f));
        bool bearable = kept > 0 && class_for(l, gravity, dt, substeps, kept_reserve) < kept;
        l.waited = bearable ? static_cast<uint8_t>(l.waited + 1) : uint8_t{0};
        if (l.waited >= patience) --kept, l.waited = 0;
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
            entry(world, list[i].slot);
            loads[list[i].slot].in_group = true;
            join(loads, list[0].slot, list[i].slot);
        }
        IslandLoad& l = loads[root(loads, list[0].slot)];
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
        if (loads[slot].step != world.steps + 1) return;
        loads[root(loads, slot)].tied |=
            !loads[slot].in_group || (world.bodies.info[other].type == BodyType::kinematic && moves(world, other));
    };
    for (uint32_t joint : world.movers.joints) {
        const JointInfo& j = world.joints.info[joint];
        mark(j.body_a, j.body_b), mark(j.body_b, j.body_a);
    }
}

}  // namespace

void choose_substeps(WorldData& world, float dt) {
    BodyStore& bodies = world.bodies;
    Array<IslandLoad>& loads = world.island_loads;
    loads.resize(bodies.slots.capacity());
    const float gravity = length(world.config.gravity);
    const float weight = gravity * dt / static_cast<float>(world.config.solver_steps);
    world.active.clear();
    world.first_loads.clear();
    for (uint32_t i : world.touching) {
        ContactRecord& r = world.records[i];
        const ColliderPair& p = world.pairs.pairs[r.pair];
        bool flipped = (r.flags & contact_flipped) != 0;
        uint32_t a = world.colliders.info[flipped ? p.b : p.a].body, b = world.colliders.info[flipped ? p.a : p.b].body;
        const BodyInfo &info_a = bodies.info[a], &info_b = bodies.info[b];
        if (info_b.asleep || info_b.type != BodyType::dynamic)
            continue;  // B moves wherever one of them does, and islands wake as one
        r.body_a = static_cast<int32_t>(a);
        r.body_b = static_cast<int32_t>(b);
        world.active.push_back(i);
        bool both = info_a.type == BodyType::dynamic;
        entry(world, b);
        if (both) {
            entry(world, a);
            join(loads, a, b);
        }
        IslandLoad& l = loads[root(loads, b)];
        ++l.contacts;
        l.tied |= info_a.type == BodyType::kinematic && moves(world, a);
        if (impulse_of(r) > 0.0f) count_load(world, r, weight, both);
        else if (!moves(world, b) && !moves(world, a)) offer_first_load(world, i, a, b, both);
    }
    if (!world.first_loads.empty()) {
        guess_first_loads(world, weight);
        for (const FirstLoad& f : world.first_loads)
            count_load(world, world.records[f.record], weight, f.lower != no_slot, first_reserve);
    }
    add_joint_groups(world, dt);
    tie_other_joints(world);
    auto decide_for = [&](uint32_t slot) {
        IslandLoad& l = loads[root(loads, slot)];
        if (!l.decided) decide(l, gravity, dt, world.config.solver_steps);
    };
    for (uint32_t i : world.active) decide_for(static_cast<uint32_t>(world.records[i].body_b));
    for (const JointGroupLoad& g : world.joint_groups) {
        uint32_t slot = world.jointed_bodies[static_cast<size_t>(g.first)].slot;
        if (!bodies.info[slot].asleep) decide_for(slot);
    }
}

int substep_class(WorldData& world, uint32_t slot) {
    if (slot >= world.island_loads.size()) return 0;
    IslandLoad& l = world.island_loads[slot];
    if (l.step != world.steps + 1) return 0;
    const IslandLoad& island = world.island_loads[root(world.island_loads, slot)];
    l.substeps = island.substeps;
    l.waited = island.waited;
    return l.substeps;
}

}  // namespace lendulet
