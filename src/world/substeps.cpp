// Which islands take more substeps than the world's setting, and which fewer. A contact that carries R times the weight
// of its lighter body sinks by 2 (leak / bias) R g h^2, and a column of size w and height H under it buckles for R (H /
// w)^2 g h^2 of about w (docs/solver.md); both shrink with the square of the substep. Small islands that need it
// therefore take 2, 4, 8 or 16 times as many substeps, and so do small groups of jointed bodies with loads or loops
// (joint_groups.cpp); large ones, where that would cost, those with other joints and those on bodies that are moved by
// hand keep to the setting. Large ones most of whose bodies move against each other flow: nothing in them stands that
// could sink or buckle, and half of the substeps do.
//
// Reads this step's contacts with their warm-start impulses, which are in units of the world's substep. Leaves the
// active ones with their bodies, and each body's class in `island_loads`.
#include <utility>

#include "base/prefetch.h"
#include "world/first_loads.h"
#include "world/island_class.h"

namespace lendulet {
namespace {

constexpr int contacts_per_task = 512;
constexpr float resting_speed = 0.5f;  // m/s; what moves faster is no load but an impact
constexpr int calm_steps = 3;  // that a body must have been slow for: what lands carries many times its weight for one
constexpr int rested = calm_steps + 1;  // in place of them: so long, and its island rested in the last step

bool moves(const WorldData& world, uint32_t slot) {
    const BodyMomenta& m = world.bodies.momenta[slot];
    return length_squared(m.p) + length_squared(m.L) > 0.0f;
}

bool moved_by_hand(const WorldData& world, uint32_t slot) {
    return world.bodies.info[slot].type == BodyType::kinematic && moves(world, slot);
}

float impulse_of(const ContactRecord& r) {
    return r.normal_impulse[0] + r.normal_impulse[1] + r.normal_impulse[2] + r.normal_impulse[3];
}

bool all_carry(const ContactRecord& r) {
    bool all = true;
    for (int j = 0; j < r.point_count; ++j) all &= r.normal_impulse[j] > 0.0f;
    return all;
}

bool has_entry(const WorldData& world, uint32_t slot) { return world.island_loads[slot].step == world.steps + 1; }

uint32_t root(uint32_t* parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

// The entries of a step while it asks what its contacts carry, one by one; with what nothing in the loop changes at
// hand.
struct LoadSurvey {
    WorldData& world;
    const BodyStore& bodies = world.bodies;
    IslandLoad* const loads = world.island_loads.data();
    uint32_t* const parent = world.load_parent.data();
    const uint64_t now = world.steps + 1;
    const Vec3 down = world.config.gravity;
    const float gravity = length(down);
    const float weight;  // what a substep of gravity gives to 1 kg, N s
    const float still_speed = rest_speed(world);

    LoadSurvey(WorldData& w, float dt) : world(w), weight(gravity * dt / static_cast<float>(w.config.solver_steps)) {}

    IslandLoad& island_of(uint32_t slot) const { return loads[root(parent, slot)]; }
    void begin(uint32_t slot);
    bool takes_part(uint32_t slot);
    uint32_t join(uint32_t a, uint32_t b);
    void sample(IslandLoad& island, const TouchingBodies& ends, bool both, Vec3 velocity_a) const;
    void count(IslandLoad& island, float impulse, const TouchingBodies& ends, bool both, bool guessed);
    void add(uint32_t record, const TouchingBodies& ends, bool sampled);
};

// Begins the entry of a body, anew in every step, with all that its contacts ask of it.
void LoadSurvey::begin(uint32_t slot) {
    IslandLoad& l = loads[slot];
    const bool known = l.step + 1 == now || l.slept;
    const uint8_t before = known ? l.substeps : uint8_t{0}, waited = known ? l.waited : uint8_t{0};
    const uint8_t pressed = known ? l.pressed : uint8_t{0};
    const uint8_t calm = known ? l.calm : uint8_t{0};
    static constexpr IslandLoad empty{};
    l = empty;  // which is copied; "= {}" calls for a slow instruction
    l.step = now;
    l.lowest = l.highest = dot(from_origin(bodies.pose[slot].position), down);
    l.before = before;
    l.waited = waited;
    l.pressed = pressed;
    l.moves = moves(world, slot);
    l.velocity = bodies.velocity(slot);
    const bool slow = length_squared(l.velocity) < resting_speed * resting_speed;
    l.calm = !l.moves            ? uint8_t{calm_steps}
             : !slow             ? uint8_t{0}
             : calm < calm_steps ? static_cast<uint8_t>(calm + 1)
                                 : uint8_t{calm_steps};
    l.slow = l.rests = l.calm >= calm_steps;
    l.still = calm == rested && length_squared(l.velocity) <= still_speed * still_speed;
    l.inverse_mass = bodies.mass[slot].inverse_mass;
    l.radius = bodies.info[slot].radius;
    l.carried = bodies.mass[slot].mass * bodies.info[slot].gravity_factor;
    parent[slot] = slot;
    world.loaded.push_back(slot);
}

// Whether the body moves by constraints in this step; its entry is then there.
bool LoadSurvey::takes_part(uint32_t slot) {
    if (loads[slot].step == now) return loads[slot].touches;
    const BodyInfo& info = bodies.info[slot];
    if (info.asleep || info.type != BodyType::dynamic) return false;
    begin(slot);
    loads[slot].touches = true;
    return true;
}

// Makes one island of two; returns its root, the smaller slot.
uint32_t LoadSurvey::join(uint32_t a, uint32_t b) {
    a = root(parent, a);
    b = root(parent, b);
    if (a == b) return a;
    if (b < a) std::swap(a, b);
    parent[b] = a;
    IslandLoad &x = loads[a], &y = loads[b];
    x.contacts += y.contacts;
    x.samples += y.samples;
    x.stirred += y.stirred;
    x.sampled_sinking += y.sampled_sinking;
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
    x.jointed |= y.jointed;
    x.rests |= y.rests;
    x.still &= y.still;
    return a;
}

// Adds what a contact carries to its island's loads, unless its bodies are fast. `both` are moving ones.
LENDULET_FORCE_INLINE void LoadSurvey::count(IslandLoad& island, float impulse, const TouchingBodies& ends, bool both,
                                             bool guessed) {
    IslandLoad &a = loads[ends.a], &b = loads[ends.b];  // that of a static body is unused
    float lightest = b.inverse_mass, radius = b.radius;
    if (both) {
        lightest = maximum(lightest, a.inverse_mass);
        radius = minimum(radius, a.radius);
    }
    // The upper body of a contact that carries is held by it.
    if (both || !ends.a_above) (ends.a_above ? a : b).held = true;
    if (!(impulse * lightest > weight) || !b.slow || (both && !a.slow)) return;
    float ratio = (guessed ? first_reserve : 1.0f) * impulse * lightest / weight;
    float size = size_of(radius);
    float &sinking = guessed ? island.sinking : island.felt_sinking,
          &buckling = guessed ? island.buckling : island.felt_buckling;
    sinking = maximum(sinking, ratio / size);
    buckling = maximum(buckling, ratio / (size * size * size));
}

// Takes a contact as a sample; its A moves with that velocity.
void LoadSurvey::sample(IslandLoad& island, const TouchingBodies& ends, bool both, Vec3 velocity_a) const {
    const IslandLoad &a = loads[ends.a], &b = loads[ends.b];
    ++island.samples;
    island.stirred += !ends.swift && is_stirred(b, velocity_a, gravity);
    float lightest = b.inverse_mass, radius = b.radius;
    if (both) {
        lightest = maximum(lightest, a.inverse_mass);
        radius = minimum(radius, a.radius);
    }
    const bool slow = b.slow && (!both || a.slow);
    const float carried = slow ? maximum(ends.impulse * lightest, weight) : weight;
    island.sampled_sinking += carried / (weight * size_of(radius));
}

// Takes a contact whose B takes part.
LENDULET_FORCE_INLINE void LoadSurvey::add(uint32_t record, const TouchingBodies& ends, bool sampled) {
    const uint32_t a = ends.a, b = ends.b;
    const bool both = !ends.fixed_a && takes_part(a);
    if (both) loads[a].meets_moving = loads[b].meets_moving = true;
    else loads[b].meets_fixed = true;
    // All that touches one body that is moved by hand goes with it, so it is one island.
    const bool carried = !both && moved_by_hand(world, a);
    if (carried && loads[a].step != now) begin(a);
    IslandLoad& island = loads[both || carried ? join(a, b) : root(parent, b)];
    ++island.contacts;
    island.tied |= carried;
    if (sampled) sample(island, ends, both, both || carried ? loads[a].velocity : Vec3{});
    if (ends.impulse > 0.0f) count(island, ends.impulse, ends, both, false);
    else if (!loads[b].moves && !moves(world, a)) offer_first_load(world, record, ends, both);
}

// Awake groups of bodies whose joints need more substeps, each as one island with its contacts.
// Their substeps grow with the step's shortness too: who takes steps of 1/240 s asks for a quarter of the gaps, not for
// the same ones by fewer substeps a step.
void add_joint_groups(LoadSurvey& survey, float dt) {
    const WorldData& world = survey.world;
    const float sharper = maximum(1.0f, 1.0f / (60.0f * dt));
    for (const JointGroupLoad& g : world.joint_groups) {
        const JointedBody* list = world.jointed_bodies.data() + g.first;
        if (world.bodies.info[list[0].slot].asleep) continue;
        for (int i = 0; i < g.count; ++i) {
            if (!has_entry(world, list[i].slot)) survey.begin(list[i].slot);
            survey.loads[list[i].slot].in_group = true;
            survey.join(list[0].slot, list[i].slot);
        }
        IslandLoad& l = survey.island_of(list[0].slot);
        l.jointed = true;
        l.contacts += g.joints;
        l.sinking = maximum(l.sinking, 0.5f * sharper * g.sinking);
        l.least = g.least > l.least ? g.least : l.least;
    }
}

// Islands with joints of other groups, or joints to kinematic bodies in motion, keep to the setting.
void tie_other_joints(LoadSurvey& survey) {
    const WorldData& world = survey.world;
    if (world.active.empty() && world.joint_groups.empty()) return;
    auto mark = [&](uint32_t slot, uint32_t other) {
        if (!has_entry(world, slot)) return;
        IslandLoad& l = survey.island_of(slot);
        l.jointed = true;
        l.tied |= !survey.loads[slot].in_group || moved_by_hand(world, other);
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
            t.held = all_carry(r);
            t.a_above = dot(Vec3{r.normal[0], r.normal[1], r.normal[2]}, world.config.gravity) > 0.0f;
            t.swift = (r.flags & contact_swift) != 0;
            t.bounces = r.restitution > 0.0f || t.swift;
            t.elastic = r.restitution >= 0.9f;
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
    world.first_loads.clear();
    world.loaded.clear();
    survey_contacts(world);
    LoadSurvey survey(world, dt);
    const size_t count = world.touching.size();
    world.active.resize_unset(count);
    world.active_bodies.resize_unset(count);
    const uint32_t* touching = world.touching.data();
    const TouchingBodies* touching_bodies = world.touching_bodies.data();
    uint32_t* active = world.active.data();
    TouchingBodies* active_bodies = world.active_bodies.data();
    for (size_t k = 0; k < count; ++k) {
        const TouchingBodies ends = touching_bodies[k];
        if (!survey.takes_part(ends.b)) continue;  // B moves wherever one of them does, and islands wake as one
        *active++ = touching[k];
        *active_bodies++ = ends;
        survey.add(touching[k], ends, k % contacts_per_sample == 0);
    }
    const auto active_count = static_cast<size_t>(active - world.active.data());
    world.active.resize_unset(active_count);
    world.active_bodies.resize_unset(active_count);
    if (!world.first_loads.empty()) {
        guess_first_loads(world, survey.weight);
        for (const FirstLoad& f : world.first_loads)
            survey.count(survey.island_of(f.bodies.b), impulse_of(world.records[f.record]), f.bodies,
                         f.lower != no_slot, true);
    }
    add_joint_groups(survey, dt);
    tie_other_joints(survey);
    for (uint32_t slot : world.loaded) {
        IslandLoad& l = survey.island_of(slot);
        if (!l.decided) decide_substeps(l, survey.gravity, dt, world.config.solver_steps);
    }
    if (!world.first_loads.empty()) settle_first_loads(world, dt);
}

void note_rest(WorldData& world) {
    const uint32_t* next = world.awake.data();
    world.rested_bodies = 0;
    for (int c = 0; c < solver_parts; ++c) {
        const int count = world.parts[c].body_count;
        if (world.solvers[c].rested()) {
            world.rested_bodies += count;
            for (int i = 0; i < count; ++i) world.island_loads[next[i]].calm = rested;
        }
        next += count;
    }
}

int part_for(WorldData& world, uint32_t slot, float dt) {
    if (slot >= world.island_loads.size() || !has_entry(world, slot))
        return goes_alone(world, slot, dt) ? alone_part : 0;
    IslandLoad& l = world.island_loads[slot];
    const IslandLoad& island = world.island_loads[root(world.load_parent.data(), slot)];
    l.substeps = island.substeps;
    l.waited = island.waited;
    l.pressed = island.pressed;
    return island.flows ? flow_part : l.substeps;
}

bool is_crowded(const WorldData& world, const TouchingBodies& bodies) {
    constexpr int crowd = 64, elastic_crowd = 4096;  // contacts
    uint32_t slot = bodies.b;                        // several threads ask: the way to the root stays as it is
    while (world.load_parent[slot] != slot) slot = world.load_parent[slot];
    return bodies.bounces && world.island_loads[slot].contacts > (bodies.elastic ? elastic_crowd : crowd);
}

}  // namespace lendulet
