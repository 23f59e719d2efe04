// Between two steps, and where islands wake: who takes part from now on. See movers.h.
#include "world/movers.h"

#include <algorithm>

#include "world/narrow/manifold_records.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

bool moves(const BodyMomenta& m) { return length_squared(m.p) + length_squared(m.L) > 0.0f; }

bool comes_to_rest(const WorldData& world, uint32_t slot) {
    const BodyInfo& info = world.bodies.info[slot];
    if (info.type == BodyType::dynamic) return info.asleep;
    return info.placed_at != static_cast<uint32_t>(world.steps) && !moves(world.bodies.momenta[slot]);
}

template <class Visit>
void for_each_collider_of(const WorldData& world, uint32_t body, Visit&& visit) {
    for (uint32_t c = world.bodies.info[body].first_collider; c != no_slot; c = world.colliders.info[c].next) visit(c);
}

void leave(WorldData& world, uint32_t slot) {
    BodyInfo& info = world.bodies.info[slot];
    info.mover_place = no_slot;
    info.solver_index = static_body;
    for_each_collider_of(world, slot, [&](uint32_t c) {
        world.at_rest[c] = 1;
        ShapeFrame& f = world.frames[c];  // where it came to rest is where it was found last
        f.velocity[0] = f.velocity[1] = f.velocity[2] = f.turning = 0.0f;
    });
    world.pairs_to_rest = true;
}

void join(WorldData& world, uint32_t slot) {
    for_each_collider_of(world, slot, [&](uint32_t c) {
        world.at_rest[c] = 0;
        world.pairs.for_each_of(c, [&](uint32_t number) {
            if (!world.pairs.pairs[number].listed) wake_pair(world, number);
        });
    });
}

// Those that go on, in order; the others leave. Their number.
size_t keep_movers(WorldData& world, size_t begin, size_t end) {
    Array<uint32_t>& bodies = world.movers.bodies;
    size_t kept = begin;
    for (size_t i = begin; i < end; ++i) {
        uint32_t slot = bodies[i];
        if (slot == no_slot) continue;
        if (comes_to_rest(world, slot)) leave(world, slot);
        else bodies[kept++] = slot;
    }
    return kept;
}

void list_colliders(WorldData& world) {
    Movers& m = world.movers;
    m.colliders.clear();
    for (uint32_t slot : m.bodies) for_each_collider_of(world, slot, [&](uint32_t c) { m.colliders.push_back(c); });
}

void list_mover_joints(WorldData& world) {
    Movers& m = world.movers;
    const JointStore& joints = world.joints;
    m.joints.clear();
    m.joints_changed = false;
    if (joints.count() == 0) return;
    m.joints.reserve(joints.info.capacity());
    auto is_mover = [&](uint32_t body) { return world.bodies.info[body].mover_place != no_slot; };
    for (uint32_t slot : m.bodies)
        joints.for_each_of(slot, [&](uint32_t joint) {
            const JointInfo& j = joints.info[joint];
            uint32_t other = j.body_a == slot ? j.body_b : j.body_a;
            if (!is_mover(other) || slot < other) m.joints.push_back(joint);
        });
    std::sort(m.joints.begin(), m.joints.end(), [&](uint32_t a, uint32_t b) {  // order: total
        return joints.slots.place(a) < joints.slots.place(b);
    });
}

// The records of a pair with its points, in or out of the sums over what rests.
void add_resting(WorldData& world, const ColliderPair& p, int sign) {
    RestingContacts& rest = world.resting;
    for (uint32_t k = 0; k < p.count; ++k)
        for (const ContactPointRecord& q : world.records[p.first_record + k].points) {
            rest.points += sign * static_cast<int>(q.separation <= 0.0f);
            if (sign > 0) rest.penetration = maximum(rest.penetration, -q.separation);
            else rest.penetration_stale |= -q.separation >= rest.penetration;
        }
}

// Takes an entry out of a list, the last one goes into its place.
template <class SetPlace>
void take_out(Array<uint32_t>& list, uint32_t place, SetPlace&& set_place) {
    list[place] = list.back();
    set_place(list[place], place);
    list.pop_back();
}

void take_record_out(WorldData& world, Array<uint32_t>& list, uint32_t record) {
    take_out(list, world.resting.place[record], [&](uint32_t r, uint32_t place) { world.resting.place[r] = place; });
}

void take_from_rest(WorldData& world, const ColliderPair& p) {
    RestingContacts& rest = world.resting;
    add_resting(world, p, -1);
    for (uint32_t k = 0; k < p.count; ++k) take_record_out(world, rest.records, p.first_record + k);
    if (!p.hit) return;
    take_out(rest.hits, p.first_record, [&](uint32_t n, uint32_t place) { world.pairs.pairs[n].first_record = place; });
    rest.hits_changed = true;
}

}  // namespace

void settle_movers(WorldData& world) {
    Movers& m = world.movers;
    if (m.leaving || m.sorted < m.bodies.size()) {
        size_t old = m.leaving ? keep_movers(world, 0, m.sorted) : m.sorted;
        size_t end = keep_movers(world, m.sorted, m.bodies.size());
        for (size_t i = m.sorted; i < end; ++i) join(world, m.bodies[i]);
        auto by_creation = [&](uint32_t a, uint32_t b) {
            return world.bodies.slots.place(a) < world.bodies.slots.place(b);
        };
        uint32_t* fresh = m.bodies.begin() + m.sorted;
        std::sort(fresh, m.bodies.begin() + end, by_creation);  // order: total
        m.merged.resize_unset(old + (end - m.sorted));
        std::merge(m.bodies.begin(), m.bodies.begin() + old, fresh, m.bodies.begin() + end, m.merged.begin(),
                   by_creation);
        m.bodies.swap(m.merged);
        m.sorted = m.bodies.size();
        for (size_t i = 0; i < m.sorted; ++i) world.bodies.info[m.bodies[i]].mover_place = static_cast<uint32_t>(i);
        m.leaving = false;
        m.joints_changed = true;
        list_colliders(world);
        // Room for all who may wake, so that waking takes no memory.
        const size_t bodies = world.bodies.info.capacity(), colliders = world.frames.capacity();
        for (Array<uint32_t>* list : {&m.bodies, &m.merged, &world.waking, &world.events.woken, &world.events.fallen})
            list->reserve(bodies);
        for (Array<uint32_t>* list : {&m.colliders, &world.changed_boxes}) list->reserve(colliders);
        world.renewed.reserve(colliders);
        world.events.sleeps.reserve(bodies);
    }
    if (m.joints_changed) list_mover_joints(world);
}

void add_mover(WorldData& world, uint32_t slot) {
    BodyInfo& info = world.bodies.info[slot];
    if (info.mover_place != no_slot) return;
    info.mover_place = static_cast<uint32_t>(world.movers.bodies.size());
    world.movers.bodies.push_back(slot);
}

void remove_mover(WorldData& world, uint32_t slot) {
    BodyInfo& info = world.bodies.info[slot];
    if (info.mover_place == no_slot) return;
    world.movers.bodies[info.mover_place] = no_slot;
    world.movers.leaving = true;
    info.mover_place = no_slot;
}

// ---------------------------------------------------------------------------------------------------------------------
// Pairs

void rest_pair(WorldData& world, uint32_t number) {
    RestingContacts& rest = world.resting;
    ColliderPair& p = world.pairs.pairs[number];
    p.rest_h = world.last_h;
    add_resting(world, p, 1);
    for (uint32_t k = 0; k < p.count; ++k) {
        rest.place[p.first_record + k] = static_cast<uint32_t>(rest.records.size());
        rest.records.push_back(p.first_record + k);
    }
    if (!p.hit) return;
    p.first_record = static_cast<uint32_t>(rest.hits.size());
    rest.hits.push_back(number);
    rest.hits_changed = true;
}

void wake_pair(WorldData& world, uint32_t number) {
    ColliderPair& p = world.pairs.pairs[number];
    take_from_rest(world, p);
    world.pairs.list(number);
    // Impulses are those of a substep; steps may have become shorter or longer meanwhile.
    if (p.rest_h == world.last_h || !(p.rest_h > 0.0f)) return;
    for (uint32_t k = 0; k < p.count; ++k) scale_impulses(world.records[p.first_record + k], world.last_h / p.rest_h);
}

void end_pair(WorldData& world, uint32_t number) {
    const ColliderPair& p = world.pairs.pairs[number];
    note_ended(world, p);
    if (!p.listed) take_from_rest(world, p);
    world.pairs.end(number);
}

void forget_pair(WorldData& world, uint32_t number) {
    const ColliderPair& p = world.pairs.pairs[number];
    if (p.listed)
        for (uint32_t k = 0; k < p.count; ++k) take_record_out(world, world.touching, p.first_record + k);
    end_pair(world, number);
}

void rest_pairs(WorldData& world) {
    if (!world.pairs_to_rest && !world.pairs.to_be_swept()) return;
    world.pairs_to_rest = false;
    auto rests = [&](const ColliderPair& p) {
        if ((world.at_rest[p.a] & world.at_rest[p.b]) == 0) return false;
        world.pairs_to_rest |= p.begun;  // it has to be collided first
        return !p.begun;
    };
    world.pairs.sweep(rests, [&](uint32_t number) { rest_pair(world, number); });
}

float deepest_at_rest(WorldData& world) {
    RestingContacts& rest = world.resting;
    if (!rest.penetration_stale) return rest.penetration;
    rest.penetration_stale = false;
    rest.penetration = 0.0f;
    for (uint32_t r : rest.records)
        for (const ContactPointRecord& q : world.records[r].points)
            rest.penetration = maximum(rest.penetration, -q.separation);
    return rest.penetration;
}

}  // namespace lendulet
