// Islands that are no numbers any more. A body whose state is not finite after a step is put back to where it was and
// stopped, so that it cannot spoil what comes near it later; and so is all that it was in contact with or joined to,
// through other moving bodies. Of what is not finite, blocks of rows hand on to bodies more or less by what else lies
// in their lanes, and that depends on the width and the number of workers: how far it came within its island must not
// show. It never comes further, for what cannot be moved is never stored to.
//
// Reads the active contacts and joints; after unpack_bodies() has marked bodies. Runs in the rare step alone.
#include "world/narrow/manifold_records.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

uint32_t root(Array<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

bool moves(const WorldData& world, uint32_t slot) {
    const BodyInfo& info = world.bodies.info[slot];
    return info.type == BodyType::dynamic && !info.asleep;
}

void put_back(WorldData& world, uint32_t slot) {
    BodyStore& bodies = world.bodies;
    BodyInfo& info = bodies.info[slot];
    bodies.pose[slot] = world.continuous.start[static_cast<size_t>(info.solver_index - reserved_bodies)];
    bodies.momenta[slot] = {};
    bodies.change[slot] = {};
    info.contained = true;
    info.capped = false;
}

// What held such an island is not to be trusted. How far its surfaces are apart is found in the next step.
void forget_contact(WorldData& world, uint32_t record) {
    ContactRecord& r = world.records[record];
    clear_impulses(r);
    for (int j = 0; j < r.point_count; ++j) r.points[j].separation = 0.0f;
    if ((r.flags & contact_rolls) == 0) return;
    for (float& x : world.extras[record].impulse) x = 0.0f;
}

void forget_joint(WorldData& world, JointRecord& r) {
    for (float* x : {r.linear, r.angular, r.impulse, r.angular_impulse}) x[0] = x[1] = x[2] = 0.0f;
    r.limit_0 = r.limit_1 = r.motor = r.spring = 0.0f;
    if (r.type != JointClass::six_degrees) return;
    for (JointAxisRecord& x : world.joint_axes[static_cast<size_t>(r.axes)].axis) x.limit = x.motor = x.spring = 0.0f;
}

}  // namespace

void contain_islands(WorldData& world) {
    BodyStore& bodies = world.bodies;
    Array<uint32_t>& parent = world.load_parent;
    parent.resize_unset(bodies.slots.capacity());
    for (uint32_t slot : world.awake) parent[slot] = slot;
    auto link = [&](uint32_t a, uint32_t b) {
        if (moves(world, a) && moves(world, b)) parent[root(parent, a)] = root(parent, b);
    };
    for (uint32_t record : world.active) {
        const ColliderPair& p = world.pairs.pairs[world.records[record].pair];
        link(p.body_a, p.body_b);
    }
    for (uint32_t joint : world.active_joints) link(world.joints.info[joint].body_a, world.joints.info[joint].body_b);
    for (uint32_t slot : world.awake)
        if (bodies.info[slot].contained) bodies.info[root(parent, slot)].contained = true;
    for (uint32_t slot : world.awake)
        if (bodies.info[root(parent, slot)].contained) put_back(world, slot);

    auto contained = [&](uint32_t a, uint32_t b) { return bodies.info[a].contained || bodies.info[b].contained; };
    for (uint32_t record : world.active) {
        const ColliderPair& p = world.pairs.pairs[world.records[record].pair];
        if (contained(p.body_a, p.body_b)) forget_contact(world, record);
    }
    for (size_t i = 0; i < world.active_joints.size(); ++i) {
        const JointInfo& j = world.joints.info[world.active_joints[i]];
        if (contained(j.body_a, j.body_b)) forget_joint(world, world.joint_records[i]);
    }
    world.joints_changed = true;  // the solver's rows hold what they held: they are made anew
    world.statistics.capped_bodies = world.statistics.contained_bodies = 0;
    for (uint32_t slot : world.awake) {
        world.statistics.capped_bodies += bodies.info[slot].capped;
        world.statistics.contained_bodies += bodies.info[slot].contained;
    }
}

}  // namespace lendulet
