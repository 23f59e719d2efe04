// Memory taken ahead: see World::reserve().
#include <algorithm>
#include <string>

#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int contacts_per_body = 3;  // of a heap of boxes
// Of bodies thrown together in a drum, the most of all scenes: boxes that overlap, and contacts found ahead.
constexpr size_t pairs_in_drum = 12, contacts_in_drum = 8;
constexpr size_t fewest_expected = 512;  // colliders: of fewer, arrays that grow cost nothing that could be seen
constexpr int most = 1 << 24;
constexpr size_t hard_contacts = 1024;

template <class... T>
void make_ready(size_t n, Array<T>&... arrays) {
    (arrays.make_ready(n), ...);
}

void make_bodies_ready(WorldData& world, size_t bodies) {
    const size_t packed = reserved_bodies + bodies + bodies / 64 + 8 * block_bodies;  // with holes
    BodyStore& b = world.bodies;
    ColliderStore& c = world.colliders;
    make_ready(bodies, b.pose, b.momenta, b.mass, b.forces, b.change, b.info, b.principal);
    make_ready(bodies, c.geometry, c.local, c.surface, c.info);
    make_ready(bodies, world.moving_boxes, world.box_place, world.changed_boxes, world.renewed, world.at_rest,
               world.frames);
    make_ready(bodies, world.movers.bodies, world.movers.colliders, world.movers.merged, world.waking);
    make_ready(bodies, world.awake, world.island_loads, world.load_parent, world.loaded, world.island_parent,
               world.island_still);
    make_ready(packed, world.continuous.start, world.continuous.is_suspect, world.continuous.fraction,
               world.deep_contacts);
    world.solver_bodies.make_ready(packed);
}

void make_contacts_ready(WorldData& world, size_t contacts) {
    world.pairs.make_ready(contacts);
    world.narrow_scratch.make_ready(static_cast<size_t>(world.tasks.workers()));
    make_ready(contacts, world.box_pairs, world.records, world.found_separations, world.touching, world.touching_bodies,
               world.active, world.active_bodies, world.active_ends, world.first_loads, world.resting.place);
}

void reserve_records(WorldData& world, size_t contacts) {
    world.records.reserve(contacts), world.found_separations.reserve(contacts), world.resting.place.reserve(contacts);
}

void make_joints_ready(WorldData& world, size_t joints) {
    JointStore& j = world.joints;
    make_ready(joints, j.info, j.impulses, j.record, world.movers.joints, world.active_joints, world.joint_records);
}

}  // namespace

// Arrays that grow while a heap comes together would be copied, and all their new pages paid for, within one step: some
// steps took four times the others. Memory that nothing was written to costs nearly nothing, and then comes page by
// page as contacts do.
void expect_contacts(WorldData& world, size_t colliders) {
    colliders = std::min(colliders, most_expected);
    if (world.contacts_given || colliders < fewest_expected || colliders <= world.expected) return;
    world.expected = colliders;
    world.pairs.reserve(pairs_in_drum * colliders);
    const size_t contacts = contacts_in_drum * colliders;
    reserve_records(world, contacts);
    world.schedule_room.rows.reserve(contacts * world.solvers[0].largest_row());
}

void expect_mesh_contacts(WorldData& world) {
    const size_t contacts = world.pairs.near_triangles.capacity() * max_mesh_manifolds;
    if (contacts > 0 && !world.contacts_given) reserve_records(world, contacts + contacts_in_drum * world.expected);
}

Status World::reserve(const Capacity& capacity) {
    WorldData& world = data();
    if (world.in_step) return Error{ErrorCode::locked, "reserve: called from inside a step"};
    const int counts[3] = {capacity.bodies, capacity.contacts, capacity.joints};
    const char* const names[3] = {"bodies", "contacts", "joints"};
    for (int i = 0; i < 3; ++i)
        if (counts[i] < 0 || counts[i] > most)
            return Error{ErrorCode::bad_config, "reserve: " + std::string(names[i]) + " is " +
                                                    std::to_string(counts[i]) + ", must be 0 .. " +
                                                    std::to_string(most)};
    const auto bodies = static_cast<size_t>(capacity.bodies), joints = static_cast<size_t>(capacity.joints);
    const size_t contacts = capacity.contacts > 0 ? static_cast<size_t>(capacity.contacts) : contacts_per_body * bodies;
    if (bodies > 0) make_bodies_ready(world, bodies);
    if (capacity.contacts > 0) world.contacts_given = true;
    expect_contacts(world, bodies);
    if (contacts > 0) make_contacts_ready(world, contacts);
    if (joints > 0) make_joints_ready(world, joints);
    const size_t entries = world.solver_bodies.state.capacity();
    world.schedule_room.make_ready(entries, contacts, world.solvers[0].largest_row());
    world.solvers[0].make_ready(entries, contacts, joints);
    world.solvers[flow_part].make_ready(0, contacts, 0);
    // Small islands under load take more substeps: room for one of them.
    for (int c = 1; c < substep_classes; ++c)
        world.solvers[c].make_ready(entries, std::min(contacts, hard_contacts), std::min(joints, hard_contacts));
    return {};
}

}  // namespace lendulet
