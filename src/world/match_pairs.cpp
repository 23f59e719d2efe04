// Stage 2: which colliders may touch. The broad phase is told which boxes have changed and gives the pairs that
// begin and end with that; where most have, or where what is fixed has, it is given all boxes and finds all pairs.
#include <algorithm>

#include "world/world_data.h"

namespace lendulet {
namespace {

// All pairs are found anew where more than one box in so many has changed. For a box that costs a little more than half
// of what it takes to tell which pairs its change begins and ends.
constexpr int most_changes = 2;

bool moved_by_constraints(const BodyInfo& info) { return info.type == BodyType::dynamic; }

PairKind kind_of(const Geometry& a, const Geometry& b) {
    auto is_ball = [](const Geometry& g) { return g.kind == GeometryKind::point; };
    auto is_box = [](const Geometry& g) { return g.kind == GeometryKind::box; };
    auto is_segment = [&](const Geometry& g) { return is_ball(g) || g.kind == GeometryKind::segment; };
    if (is_sharp_box(a) && is_sharp_box(b)) return PairKind::boxes;
    if (is_segment(a) && is_segment(b)) return PairKind::segments;
    if (is_box(a) && is_ball(b)) return PairKind::box_ball;
    if (is_ball(a) && is_box(b)) return PairKind::ball_box;
    return has_closed_form(a, b) ? PairKind::plain : PairKind::general;
}

}  // namespace

bool wanted(const WorldData& world, const BoxPair& p) {
    const ColliderInfo& a = world.colliders.info[p.a];
    const ColliderInfo& b = world.colliders.info[p.b];
    if (a.body == b.body || !filters_match(a.filter, b.filter)) return false;
    if (a.is_trigger && b.is_trigger) return false;
    const BodyInfo& ba = world.bodies.info[a.body];
    const BodyInfo& bb = world.bodies.info[b.body];
    if (!moved_by_constraints(ba) && !moved_by_constraints(bb) && !a.is_trigger && !b.is_trigger) return false;
    return !world.joints.keeps_apart(a.body, b.body);
}

const BroadBox& box_of(const WorldData& world, uint32_t collider) {
    bool fixed = world.bodies.info[world.colliders.info[collider].body].type == BodyType::fixed;
    return (fixed ? world.fixed_boxes : world.moving_boxes)[world.box_place[collider]];
}

uint32_t begin_pair(WorldData& world, const BoxPair& colliders) {
    const ColliderStore& c = world.colliders;
    const uint32_t number = world.pairs.begin(colliders.a, colliders.b, c.slots.capacity());
    ColliderPair& p = world.pairs.pairs[number];
    // One that nothing moves is looked at but once.
    world.pairs_to_rest |= (world.at_rest[p.a] & world.at_rest[p.b]) != 0;
    const Geometry &a = c.geometry[p.a], &b = c.geometry[p.b];
    p.flipped = !moved_by_constraints(world.bodies.info[c.info[p.b].body]);
    p.fixed_a = p.flipped || !moved_by_constraints(world.bodies.info[c.info[p.a].body]);
    p.body_a = c.info[p.flipped ? p.b : p.a].body;
    p.body_b = c.info[p.flipped ? p.a : p.b].body;
    if (c.info[p.a].is_trigger || c.info[p.b].is_trigger) {
        p.kind = PairKind::trigger;
        return number;
    }
    world.pairs.place_records(p, has_triangles(a) || has_triangles(b));
    p.kind = p.flipped ? kind_of(b, a) : kind_of(a, b);
    p.bounces = p.kind == PairKind::boxes && combine(c.surface[p.a], c.surface[p.b]).restitution > 0.0f;
    return number;
}

namespace {

// Whether the broad phase has not had the collider's box before this step.
bool is_new(const WorldData& world, uint32_t collider) {
    return world.colliders.info[collider].boxed_at == static_cast<uint32_t>(world.steps);
}

// From all pairs, sorted: ends those on the list that are not among them, and leaves those that are not in the table.
// Two colliders at rest have their pair already, unless one has just come.
void compare_all(WorldData& world) {
    PairTable& table = world.pairs;
    table.sort(world.box_pairs);
    auto take_off = [&](uint32_t number) {
        note_ended(world, table.pairs[number]);
        table.take_off(number);
    };
    size_t at = 0, kept = 0, fresh = 0;
    auto key = [](const auto& p) { return uint64_t{p.a} << 32 | p.b; };
    for (const BoxPair& p : world.box_pairs) {
        while (at < table.listed.size() && key(table.listed[at]) < key(p)) take_off(table.listed[at++].pair);
        if (at < table.listed.size() && key(table.listed[at]) == key(p)) {
            table.listed[kept++] = table.listed[at++];
            continue;
        }
        bool resting = (world.at_rest[p.a] & world.at_rest[p.b]) != 0, come = is_new(world, p.a) || is_new(world, p.b);
        if (!resting || (come && table.find(p.a, p.b) == no_pair)) world.box_pairs[fresh++] = p;
    }
    while (at < table.listed.size()) take_off(table.listed[at++].pair);
    table.listed.resize_unset(kept);
    world.box_pairs.resize_unset(fresh);
}

// A joint between two bodies came or went: their pairs may begin or end though no box has changed.
void match_joined(WorldData& world, const BodyPair& bodies) {
    for (uint32_t i = world.bodies.info[bodies.a].first_collider; i != no_slot; i = world.colliders.info[i].next)
        for (uint32_t k = world.bodies.info[bodies.b].first_collider; k != no_slot; k = world.colliders.info[k].next) {
            const BoxPair p{std::min(i, k), std::max(i, k)};
            const BroadBox &a = box_of(world, p.a), &b = box_of(world, p.b);
            bool overlap = true;
            for (int d = 0; d < 3; ++d) overlap &= a.lower[d] <= b.upper[d] && b.lower[d] <= a.upper[d];
            bool want = overlap && wanted(world, p);
            uint32_t number = world.pairs.find(p.a, p.b);
            if (want && number == no_pair) begin_pair(world, p);
            if (!want && number != no_pair) end_pair(world, number);
        }
}

// The places that differ, rising and each once, without those that are gone.
void tidy_changes(WorldData& world) {
    Array<uint32_t>& changed = world.changed_boxes;
    std::sort(changed.begin(), changed.end());  // order: total
    size_t n = static_cast<size_t>(std::unique(changed.begin(), changed.end()) - changed.begin());
    while (n > 0 && changed[n - 1] >= world.moving_boxes.size()) --n;
    changed.resize_unset(n);
}

// A removed collider's number may be that of a new one, which the broad phase takes for the old one, moved: what both
// overlap begins unnoticed. So does what a collider with another filter lies in.
void match_reused(WorldData& world, uint32_t collider) {
    Array<uint32_t>& near = world.continuous.near[0];
    const BroadBox& box = box_of(world, collider);
    near.clear();
    world.broad_phase.query_box(box.lower, box.upper, near);
    std::sort(near.begin(), near.end());  // order: total
    for (uint32_t other : near) {
        const BoxPair p{std::min(collider, other), std::max(collider, other)};
        if (other != collider && world.pairs.find(p.a, p.b) == no_pair && wanted(world, p)) begin_pair(world, p);
    }
}

}  // namespace

void find_box_pairs(WorldData& world) {
    const BroadBox* boxes = world.moving_boxes.data();
    const int count = world.moving_boxes.count();
    world.box_pairs.clear();
    world.ended_pairs.clear();
    if (world.fixed_changed)
        world.broad_phase.set_fixed(world.fixed_boxes.data(), world.fixed_boxes.count(), &world.tasks);
    world.all_pairs_sought |= world.fixed_changed || int64_t{world.changed_boxes.count()} * most_changes > count;
    world.fixed_changed = false;
    if (world.all_pairs_sought) {
        world.broad_phase.move_all(boxes, count, &world.tasks);
        world.broad_phase.find_pairs(world.tasks, world.box_pairs);
    } else if (!world.changed_boxes.empty() || count != world.known_boxes) {
        tidy_changes(world);
        world.broad_phase.update(world.tasks, boxes, count, world.changed_boxes.data(), world.changed_boxes.count(),
                                 world.box_pairs, world.ended_pairs);
    }
    world.known_boxes = count;
    world.changed_boxes.clear();
}

void match_pairs(WorldData& world) {
    PairTable& table = world.pairs;
    if (table.to_be_merged()) table.merge();
    rest_pairs(world);
    if (world.all_pairs_sought) compare_all(world);
    for (const BoxPair& p : world.ended_pairs)
        if (uint32_t number = table.find(p.a, p.b); number != no_pair) end_pair(world, number);
    if (!world.box_pairs.empty()) expect_contacts(world, world.moving_boxes.size());
    table.make_room(world.box_pairs.size());
    for (const BoxPair& p : world.box_pairs)
        if (wanted(world, p)) begin_pair(world, p);
    if (!world.all_pairs_sought)
        for (uint32_t c : world.forgotten)
            if (world.box_place[c] != no_box) match_reused(world, c);
    for (uint32_t c : world.refiltered)
        if (world.colliders.info[c].boxed && world.box_place[c] != no_box) match_reused(world, c);
    for (const BodyPair& bodies : world.rejoined) match_joined(world, bodies);
    world.forgotten.clear();
    world.rejoined.clear();
    world.refiltered.clear();
    world.all_pairs_sought = false;
    if (table.to_be_merged()) table.merge();
    if (table.to_be_swept()) rest_pairs(world);
}

}  // namespace lendulet
