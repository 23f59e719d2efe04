// One step of a world, as a table of contents.
#include <chrono>

#include "world/island_class.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr double least_shared_ms = 0.4;    // a step that takes less on one thread gains nothing by several
constexpr uint64_t trial = 64;             // steps after which one that several take little for is tried on one
constexpr float longest_step = 1.0f;       // s; longer ones are cut
constexpr float longest_update = 1000.0f;  // s

// Time since the last lap, booked to a stage.
class StageClock {
public:
    explicit StageClock(StepStatistics& statistics) : statistics_(statistics) {
        for (double& ms : statistics_.stage_ms) ms = 0.0;
        statistics_.total_ms = 0.0;
    }
    void lap(Stage stage) {
        auto now = Clock::now();
        double ms = std::chrono::duration<double, std::milli>(now - last_).count();
        statistics_.stage_ms[static_cast<int>(stage)] += ms;
        statistics_.total_ms += ms;
        last_ = now;
    }

private:
    using Clock = std::chrono::steady_clock;
    StepStatistics& statistics_;
    Clock::time_point last_ = Clock::now();
};

void prepare_solvers(WorldData& world, float dt) {
    JointReuse reuse = pack_joints(world, dt / static_cast<float>(world.config.solver_steps));
    const ContactRecord* records = world.records.data();
    size_t bytes = 0, first[solver_parts];
    for (int c = solver_parts - 1; c >= 0; --c) {
        const SolverPart& part = world.parts[c];
        first[c] = bytes;
        bytes += world.solvers[c].schedule(
            world.schedule_room.sorter, world.solver_bodies, world.active_ends.data() + part.first_contact,
            world.active.data() + part.first_contact, {part.contact_count, part.row_count}, part.cut,
            world.has_extras ? world.extras.data() : nullptr);
        // Islands go up by any number of classes and come down one by one, also long after all has come to rest.
        if (c > 0 && part.contact_count > 0) world.solvers[c == flow_part ? 0 : c - 1].make_room(world.solvers[c]);
    }
    Array<std::byte>& rows = world.schedule_room.rows;
    rows.clear();
    rows.resize_unset(bytes);
    for (int c = 0; c < solver_parts; ++c) {
        const SolverPart& part = world.parts[c];
        ContactList contacts{records, world.active.data() + part.first_contact, part.contact_count, dt};
        world.solvers[c].prepare(world.tasks, world.solver_bodies, records, rows.data() + first[c],
                                 1.0f / substep_multiple(c));
        JointList joints{world.joint_records.data() + part.first_joint, part.joint_count, world.joint_axes.data()};
        world.solvers[c].prepare_joints(world.tasks, world.solver_bodies, joints, contacts, reuse);
    }
}

// Whether the next step is done on one thread, by what the last one took. Results do not tell.
bool goes_alone(const WorldData& world) {
    if (world.steps == 0) return false;
    const bool short_step = world.statistics.total_ms < least_shared_ms;
    return short_step && (world.went_alone || world.steps % trial == 0);
}

// `last`: the step is the last part of an update, after which applied forces end.
void step(WorldData& world, float dt, bool last) {
    world.went_alone = goes_alone(world);
    const TaskPool::Alone alone(world.tasks, world.went_alone);
    const TaskPool::Session session(world.tasks);
    StageClock clock(world.statistics);
    const SolverSettings settings{dt, world.config.solver_steps, length(world.config.gravity)};

    settle_movers(world);
    limit_motion(world);
    update_bounds(world, dt);
    clock.lap(Stage::bounds);
    find_box_pairs(world);
    clock.lap(Stage::broad_phase);
    match_pairs(world);
    clock.lap(Stage::pairs);
    find_contacts(world, dt);
    clock.lap(Stage::narrow_phase);
    update_islands(world, dt);
    clock.lap(Stage::islands);
    find_joint_groups(world);
    choose_substeps(world, dt);
    place_bodies(world, dt);
    pack_contacts(world);
    pack_bodies(world, dt);
    limit_recovery(world, dt);
    pack_extras(world, dt);
    prepare_solvers(world, dt);
    watch_contacts(world);
    clock.lap(Stage::prepare);
    for (int c = 0; c < solver_parts; ++c) {
        SolverSettings s = settings;
        s.substeps = static_cast<int>(substep_multiple(c) * static_cast<float>(settings.substeps));
        if (c > 0 && c < substep_classes) s.rest_speed = rest_speed(world);
        world.solvers[c].solve(world.tasks, s, world.solver_bodies, world.records.data(), world.parts[c].bodies);
    }
    note_rest(world);
    world.solvers[0].coast(world.tasks, settings, world.solver_bodies, world.alone);
    clock.lap(Stage::solve);
    for (Solver& solver : world.solvers) {
        solver.store(world.tasks, world.solver_bodies, world.records.data());
        solver.store_joints(world.tasks);
    }
    unpack_bodies(world, dt, last);
    stop_at_impacts(world, dt);
    report_events(world);
    finish_step(world, dt);
    break_joints(world);
    clock.lap(Stage::finish);
}

}  // namespace

void finish_step(WorldData& world, float dt) {
    StepStatistics& s = world.statistics;
    s.bodies = world.bodies.slots.count();
    s.awake_bodies = world.awake.count();
    s.pairs = world.pairs.count();
    s.manifolds = world.touching.count() + world.resting.records.count();
    s.contact_points = world.awake_points + world.resting.points;
    s.max_penetration = maximum(world.awake_penetration, deepest_at_rest(world));
    s.colours = s.overflow_manifolds = 0;
    size_t row_bytes = 0;
    for (const Solver& solver : world.solvers) {
        s.colours = s.colours > solver.colour_count() ? s.colours : solver.colour_count();
        s.overflow_manifolds += solver.overflow();
        row_bytes += solver.row_bytes();
    }
    s.joints = world.joints.count();
    s.hard_bodies = world.hard_bodies;
    s.flowing_bodies = world.flowing_bodies;
    s.rested_bodies = world.rested_bodies;
    s.bytes_per_body = BodyStore::bytes_per_body() + sizeof(BodyState) + sizeof(BodyInertia) + sizeof(BodyStart) +
                       sizeof(BodyMotion) + sizeof(BodyPlace) + sizeof(BodyBlock) / block_bodies;
    s.bytes_per_manifold = sizeof(ContactRecord) + sizeof(FoundSeparations) + sizeof(ColliderPair) +
                           sizeof(ListedPair) + sizeof(PairCache) + sizeof(KeptPose) +
                           (world.active.empty() ? 0 : row_bytes / world.active.size());
    world.joints_h = world.last_h;
    world.time += dt;
    ++world.steps;
    world.query_scene.moved(world.movers.colliders);
}

Status World::update(float dt) {
    WorldData& world = data();
    if (!is_finite(dt) || dt < 0.0f)
        return Error{ErrorCode::bad_time_step, "update: dt is " + text(dt) + ", must be finite and not negative"};
    if (dt > longest_update)
        return Error{ErrorCode::bad_time_step,
                     "update: dt is " + text(dt) + ", must be at most " + text(longest_update)};
    if (world.in_step) return Error{ErrorCode::locked, "update: called from inside a step"};
    if (dt == 0.0f) return {};
    world.in_step = true;
    clear_events(world.events);
    int parts = 1;
    while (dt > longest_step * static_cast<float>(parts)) ++parts;
    float part = minimum(dt / static_cast<float>(parts), longest_step);
    for (int i = 0; i < parts; ++i) step(world, part, i == parts - 1);
    world.in_step = false;
    return {};
}

}  // namespace lendulet
