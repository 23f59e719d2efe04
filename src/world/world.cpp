// Worlds: settings, handles, iteration, figures.
#include "lendulet/world.h"

#include <atomic>

#include "base/hash.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

TaskPool::Hook task_hook(const WorldConfig& c) { return {c.tasks.user, c.tasks.workers, c.tasks.parallel_for}; }

constexpr int most_kept_removed = 1 << 24;
constexpr float max_gravity = 1e9f;  // m/s^2; its square is still far from overflow

// Worlds are numbered in turn, 1 to 255, for their handles alone: no result depends on it.
uint32_t next_world_number() {
    static std::atomic<uint32_t> built{0};
    return built.fetch_add(1, std::memory_order_relaxed) % 255 + 1;
}

Error bad_config(std::string what) { return {ErrorCode::bad_config, "build: " + std::move(what)}; }

Status check_gravity(Vec3 g, const char* call) {
    if (!is_finite(g)) return Error{ErrorCode::non_finite, std::string(call) + ": gravity must be finite"};
    if (max_component(absolute(g)) > max_gravity)
        return Error{ErrorCode::bad_config,
                     std::string(call) + ": gravity must not be beyond " + text(max_gravity) + " m/s^2"};
    return {};
}

Status check_hit_speed(float speed, const char* call) {
    if (speed >= 0.0f && is_finite(speed)) return {};
    return Error{ErrorCode::bad_config, std::string(call) + ": hit speed is " + text(speed) + ", must not be negative"};
}

Status check_config(const WorldConfig& c) {
    if (Status s = check_gravity(c.gravity, "build"); !s) return s;
    if (c.solver_steps < 1 || c.solver_steps > 64)
        return bad_config("solver steps are " + std::to_string(c.solver_steps) + ", must be 1 to 64");
    if (!(c.rigid_separation_speed > 0.0f) || !is_finite(c.rigid_separation_speed))
        return bad_config("rigid separation speed is " + text(c.rigid_separation_speed) + ", must be positive");
    if (!(c.static_separation_speed > 0.0f) || !is_finite(c.static_separation_speed))
        return bad_config("static separation speed is " + text(c.static_separation_speed) + ", must be positive");
    if (!(c.friction >= 0.0f && c.friction <= max_friction))
        return bad_config("friction is " + text(c.friction) + ", must be between 0 and " + text(max_friction));
    if (!(c.restitution >= 0.0f && c.restitution <= 1.0f))
        return bad_config("bounciness is " + text(c.restitution) + ", must be between 0 and 1");
    if (c.workers < 1 || c.workers > 64)
        return bad_config("workers are " + std::to_string(c.workers) + ", must be 1 to 64");
    if (c.width != 0 && c.width != 1 && c.width != 4 && c.width != 8 && c.width != 16)
        return bad_config("width is " + std::to_string(c.width) + ", must be 1, 4, 8 or 16");
    if (Status s = check_hit_speed(c.hit_speed, "build"); !s) return s;
    if (c.kept_removed < 0 || c.kept_removed > most_kept_removed)
        return bad_config("kept_removed is " + std::to_string(c.kept_removed) + ", must be 0 to " +
                          std::to_string(most_kept_removed));
    if (c.broad_phase > BroadPhaseType::wide_tree) return bad_config("that broad phase is none");
    if (c.simplex > SimplexSolver::half_space) return bad_config("that simplex solver is none");
    if (c.integrator > Integrator::runge_kutta_4) return bad_config("that integrator is none");
    if ((c.allocator.allocate == nullptr) != (c.allocator.free == nullptr))
        return bad_config("an allocator hook needs both allocate and free");
    return {};
}

}  // namespace

WorldData::WorldData(const WorldConfig& settings, uint32_t number)
    : config(settings),
      memory{settings.allocator.user, settings.allocator.allocate, settings.allocator.free},
      tasks(settings.workers, task_hook(settings)),
      bodies(&memory, number),
      colliders(&memory, number),
      joints(&memory, number),
      removed(&memory),
      broad_phase(settings.broad_phase, &memory),
      moving_boxes(&memory),
      fixed_boxes(&memory),
      fixed_boxes_before(&memory),
      box_place(&memory),
      changed_boxes(&memory),
      renewed(&memory),
      forgotten(&memory),
      box_pairs(&memory),
      ended_pairs(&memory),
      pairs(&memory),
      rejoined(&memory),
      refiltered(&memory),
      movers(&memory),
      resting(&memory),
      at_rest(&memory),
      events(&memory),
      continuous(&memory, tasks.workers()),
      query_scene(&memory),
      frames(&memory),
      narrow_kernels(lendulet::narrow_kernels(settings.width)),
      body_kernels(lendulet::body_kernels(settings.width)),
      narrow_scratch(&memory),
      records(&memory),
      found_separations(&memory),
      extras(&memory),
      deep_contacts(&memory),
      eased(&memory),
      touching(&memory),
      touching_bodies(&memory),
      active(&memory),
      active_bodies(&memory),
      active_ends(&memory),
      unsorted(&memory),
      unsorted_ends(&memory),
      overlaps(&memory),
      active_joints(&memory),
      joint_records(&memory),
      joint_axes(&memory),
      fixed_joints(&memory),
      joint_bodies(&memory),
      joint_groups(&memory),
      jointed_bodies(&memory),
      jointed_seen(&memory),
      jointed_mass(&memory),
      jointed_roots(&memory),
      awake(&memory),
      solver_bodies(&memory),
      island_loads(&memory),
      load_parent(&memory),
      loaded(&memory),
      first_loads(&memory),
      parts{},
      schedule_room(&memory),
      solvers{{&memory, settings.width}, {&memory, settings.width}, {&memory, settings.width},
              {&memory, settings.width}, {&memory, settings.width}, {&memory, settings.width}},
      island_parent(&memory),
      island_still(&memory),
      touched_sleepers(&memory),
      seams(&memory),
      waking(&memory) {}

Result<World> WorldBuilder::build() const {
    if (Status s = check_config(config_); !s) return s.error();
    WorldConfig config = config_;
    if (config.width == 0) config.width = native_width();
    return World(std::make_unique<WorldData>(config, next_world_number()));
}

World::World(std::unique_ptr<WorldData> data) : data_(std::move(data)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

WorldData& World::data() const {
    if (!data_) detail::fail({ErrorCode::stale_id, "this world was moved from"});
    return *data_;
}

bool World::alive(BodyId id) const { return data().bodies.alive(id); }
bool World::alive(ColliderId id) const { return data().colliders.alive(id); }
RigidBodyRef World::get(BodyId id) {
    if (!alive(id)) detail::fail(no_such(data().bodies.slots, id.generation, "get", "body"));
    if (data().bodies.info[id.index].type == BodyType::fixed)
        detail::fail({ErrorCode::stale_id, "get: that body is static; use get_static"});
    return RigidBodyRef(data(), id);
}
const RigidBodyRef World::get(BodyId id) const { return const_cast<World*>(this)->get(id); }
StaticBodyRef World::get_static(BodyId id) const {
    if (!alive(id)) detail::fail(no_such(data().bodies.slots, id.generation, "get_static", "body"));
    return StaticBodyRef(data(), id);
}

Status World::set_gravity(Vec3 gravity) {
    if (Status s = check_gravity(gravity, "set_gravity"); !s) return s;
    data().config.gravity = gravity;
    for (uint32_t slot : data().bodies.slots.order()) wake_body(data(), slot);
    return {};
}
Status World::set_hit_speed(float speed) {
    if (Status s = check_hit_speed(speed, "set_hit_speed"); !s) return s;
    data().config.hit_speed = speed;
    return {};
}
const WorldConfig& World::config() const { return data().config; }
const StepStatistics& World::statistics() const { return data().statistics; }
double World::time() const { return data().time; }
uint64_t World::step_count() const { return data().steps; }

int World::body_count() const { return data().bodies.slots.count(); }
BodyId World::body(int index) const {
    if (index < 0 || index >= body_count()) return {};
    return data().bodies.id(data().bodies.slots.in_order(index));
}
int World::moved_bodies(std::span<BodyId> out) const {
    size_t count = 0;
    for (uint32_t slot : data().movers.bodies) {
        if (slot == no_slot) continue;
        if (count < out.size()) out[count] = data().bodies.id(slot);
        ++count;
    }
    return static_cast<int>(count);
}
int World::contact_count() const { return data().touching.count() + data().resting.records.count(); }
BodyId World::body_of(ColliderId id) const {
    return data().colliders.alive(id) ? data().bodies.id(data().colliders.info[id.index].body) : BodyId{};
}
std::vector<int> World::contact_colours() const {
    const WorldData& world = data();
    std::vector<int> by_record(world.records.size(), -1);
    // Parts with other numbers of substeps are solved one after the other, each with colours of its own.
    int first = 0;
    for (const Solver& solver : world.solvers) {
        solver.for_each_coloured([&](uint32_t record, int colour) {
            if (record < by_record.size()) by_record[record] = first + colour;
        });
        first += solver.colour_count();
    }
    std::vector<int> colours;
    for (uint32_t record : world.touching) colours.push_back(by_record[record]);
    colours.resize(static_cast<size_t>(contact_count()), -1);
    return colours;
}

int64_t World::island(BodyId id) const {
    const WorldData& world = data();
    if (!alive(id)) return -1;
    const BodyInfo& info = world.bodies.info[id.index];
    uint32_t slot = id.index;
    if (info.type != BodyType::dynamic || info.asleep || slot >= world.island_parent.size()) return -1;
    while (world.island_parent[slot] < slot) slot = world.island_parent[slot];  // the smaller slot leads
    return slot;
}

std::span<const Overlap> World::overlaps() const { return {data().overlaps.data(), data().overlaps.size()}; }
std::span<const std::string> World::warnings() const { return data().warnings; }

Contact World::contact(int index) const {
    const WorldData& world = data();
    if (index < 0 || index >= contact_count()) return Contact{};
    const auto i = static_cast<size_t>(index), awake = world.touching.size();
    const ContactRecord& r = world.records[i < awake ? world.touching[i] : world.resting.records[i - awake]];
    const ColliderPair& p = world.pairs.pairs[r.pair];
    bool flipped = (r.flags & contact_flipped) != 0;
    uint32_t a = flipped ? p.b : p.a, b = flipped ? p.a : p.b;
    uint32_t body_a = world.colliders.info[a].body, body_b = world.colliders.info[b].body;
    Contact c{};
    c.body_a = world.bodies.id(body_a);
    c.body_b = world.bodies.id(body_b);
    c.collider_a = world.colliders.id(a);
    c.collider_b = world.colliders.id(b);
    c.normal = {r.normal[0], r.normal[1], r.normal[2]};
    c.friction_impulse = {r.friction_impulse[0], r.friction_impulse[1], r.friction_impulse[2]};
    c.point_count = r.points[0].separation == far_separation ? 0 : r.point_count;  // see seams.cpp
    c.triangle = r.triangle;
    // The points were found at the start of the step; they ride with the body that they belong to.
    Position origin = world.bodies.pose[body_b].position - Vec3{r.arm_offset[0], r.arm_offset[1], r.arm_offset[2]};
    for (int j = 0; j < c.point_count; ++j) {
        const ContactPointRecord& q = r.points[j];
        c.points[j] = {origin + Vec3{q.position[0], q.position[1], q.position[2]}, q.separation, r.normal_impulse[j]};
    }
    return c;
}

double World::kinetic_energy() const {
    double sum = 0.0;
    for (uint32_t slot : data().bodies.slots.order())
        if (data().bodies.info[slot].type == BodyType::dynamic) {
            const BodyMomenta& m = data().bodies.momenta[slot];
            sum += 0.5 * (static_cast<double>(dot(m.p, data().bodies.velocity(slot))) +
                          dot(m.L, data().bodies.angular_velocity(slot)));
        }
    return sum;
}

double World::potential_energy() const {
    double sum = 0.0;
    const Vec3 g = data().config.gravity;
    for (uint32_t slot : data().bodies.slots.order()) {
        const BodyInfo& info = data().bodies.info[slot];
        if (info.type != BodyType::dynamic) continue;
        Position x = data().bodies.pose[slot].position;
        double along = static_cast<double>(g.x) * x.x + static_cast<double>(g.y) * x.y + static_cast<double>(g.z) * x.z;
        sum -= static_cast<double>(data().bodies.mass[slot].mass) * info.gravity_factor * along;
    }
    return sum;
}

Momentum World::momentum() const {
    Momentum total{};
    for (uint32_t slot : data().bodies.slots.order()) {
        if (data().bodies.info[slot].type != BodyType::dynamic) continue;
        const BodyMomenta& m = data().bodies.momenta[slot];
        Position at = data().bodies.pose[slot].position;
        double x[3] = {at.x, at.y, at.z}, p[3] = {m.p.x, m.p.y, m.p.z}, L[3] = {m.L.x, m.L.y, m.L.z};
        for (int i = 0; i < 3; ++i) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            total.linear[i] += p[i];
            total.angular[i] += L[i] + (x[j] * p[k] - x[k] * p[j]);
        }
    }
    return total;
}

uint64_t World::hash() const {
    const WorldData& world = data();
    uint64_t h = hash_combine(0, world.bodies.slots.order().size());
    for (uint32_t slot : world.bodies.slots.order()) {
        const Pose& pose = world.bodies.pose[slot];
        const BodyMomenta& m = world.bodies.momenta[slot];
        float values[13] = {pose.position.x,
                            pose.position.y,
                            pose.position.z,
                            pose.orientation.x,
                            pose.orientation.y,
                            pose.orientation.z,
                            pose.orientation.w,
                            m.p.x,
                            m.p.y,
                            m.p.z,
                            m.L.x,
                            m.L.y,
                            m.L.z};
        h = hash_floats(h, values, 13);
    }
    // Contacts in no order: which of them rest, and since when, is not part of the state.
    uint64_t contacts = 0;
    for (const Array<uint32_t>* list : {&world.touching, &world.resting.records})
        for (uint32_t i : *list) {
            const ContactRecord& r = world.records[i];
            const ColliderPair& p = world.pairs.pairs[r.pair];
            uint64_t c = hash_combine(uint64_t{p.a} << 32 | p.b, r.key);
            c = hash_floats(c, r.normal_impulse, r.point_count);
            c = hash_floats(c, r.friction_impulse, 3);
            c = hash_floats(c, &r.twist_impulse, 1);
            if ((r.flags & contact_rolls) != 0) c = hash_floats(c, world.extras[i].impulse, 3);
            contacts += c;
        }
    return hash_joints(world, hash_combine(h, contacts));
}

}  // namespace lendulet
