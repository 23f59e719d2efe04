// Verifies that the parts of a world agree with each other; tests run it between steps.
#include "world/world_data.h"

namespace lendulet {

namespace {

std::string check_contacts(const WorldData& w, const Array<uint32_t>& records, bool listed) {
    for (size_t at = 0; at < records.size(); ++at) {
        if (records[at] >= w.records.size()) return "a touching record is out of range";
        const ContactRecord& r = w.records[records[at]];
        if (w.resting.place[records[at]] != at) return "a touching record is not where its place says";
        if (w.pairs.pairs[r.pair].a == no_pair) return "a touching record is of a pair that has ended";
        if (w.pairs.pairs[r.pair].listed != listed) return "a touching record is in the wrong list";
        if (r.point_count < 1 || r.point_count > 4) return "a manifold has an impossible number of points";
        float n = r.normal[0] * r.normal[0] + r.normal[1] * r.normal[1] + r.normal[2] * r.normal[2];
        if (!(n > 0.999f && n < 1.001f)) return "a contact normal is not a unit vector";
        for (int j = 0; j < r.point_count; ++j)
            if (!(r.normal_impulse[j] >= 0.0f)) return "a contact pulls";
    }
    return {};
}

std::string check_pairs(const WorldData& w) {
    for (size_t i = 1; i < w.pairs.listed.size(); ++i) {
        const ListedPair &p = w.pairs.listed[i - 1], &q = w.pairs.listed[i];
        if (p.a > q.a || (p.a == q.a && p.b > q.b)) return "the pair list is not sorted";
    }
    int hung = 0;
    for (uint32_t c : w.colliders.slots.order()) {
        std::string problem;
        w.pairs.for_each_of(c, [&](uint32_t number) {
            const ColliderPair& p = w.pairs.pairs[number];
            ++hung;
            if (p.a != c && p.b != c) problem = "a pair hangs on a collider that is not its own";
            else if (w.pairs.find(p.a, p.b) != number) problem = "two colliders have two pairs";
        });
        if (!problem.empty()) return problem;
    }
    return hung == 2 * w.pairs.count() ? "" : "a pair hangs on a collider that is gone";
}

// Right after a step the table has all pairs that it should have, and no others.
std::string check_completeness(const WorldData& w) {
    bool told = !w.fixed_changed && w.changed_boxes.empty() && w.forgotten.empty() && w.rejoined.empty() &&
                w.refiltered.empty();
    if (!told) return {};
    if (const char* problem = w.broad_phase.check(); *problem) return problem;
    int found = 0;
    Array<uint32_t> near;
    for (const BroadBox& box : w.moving_boxes) {
        near.clear();
        w.broad_phase.query_box(box.lower, box.upper, near);
        for (uint32_t other : near) {
            bool other_moves = w.bodies.info[w.colliders.info[other].body].type != BodyType::fixed;
            if (other == box.index || (other_moves && other < box.index)) continue;
            const BoxPair p{other < box.index ? other : box.index, other < box.index ? box.index : other};
            if (!wanted(w, p)) continue;
            ++found;
            if (w.pairs.find(p.a, p.b) == no_pair) return "two colliders whose boxes overlap are no pair";
        }
    }
    return found == w.pairs.count() ? "" : "two colliders are a pair though their boxes do not overlap";
}

std::string check_movers(const WorldData& w) {
    for (size_t i = 0; i < w.movers.bodies.size(); ++i) {
        uint32_t slot = w.movers.bodies[i];
        if (slot != no_slot && w.bodies.info[slot].mover_place != i) return "a mover is not where its place says";
    }
    for (size_t i = 0; i < w.moving_boxes.size(); ++i)
        if (w.box_place[w.moving_boxes[i].index] != i) return "a box is not where its place says";
    for (uint32_t slot : w.bodies.slots.order()) {
        const BodyInfo& info = w.bodies.info[slot];
        bool mover = info.mover_place != no_slot;
        if (mover && w.movers.bodies[info.mover_place] != slot) return "a mover is not in the list of movers";
        if (!mover && info.type == BodyType::dynamic && !info.asleep) return "a body is awake and does not take part";
    }
    return {};
}

}  // namespace

std::string World::check() const {
    const WorldData& w = data();
    for (uint32_t slot : w.bodies.slots.order()) {
        const BodyInfo& info = w.bodies.info[slot];
        int colliders = 0;
        for (uint32_t c = info.first_collider; c != no_slot; c = w.colliders.info[c].next, ++colliders)
            if (w.colliders.info[c].body != slot) return "a collider in a body's list belongs to another body";
        if (colliders != info.collider_count) return "a body's count of colliders is wrong";
        float norm = dot(w.bodies.pose[slot].orientation, w.bodies.pose[slot].orientation);
        if (!(norm > 0.999f && norm < 1.001f)) return "an orientation has lost its unit length";
        if (info.type == BodyType::dynamic && !(w.bodies.mass[slot].inverse_mass > 0.0f))
            return "a dynamic body has no mass";
    }
    if (std::string problem = check_movers(w); !problem.empty()) return problem;
    if (std::string problem = check_pairs(w); !problem.empty()) return problem;
    if (std::string problem = check_completeness(w); !problem.empty()) return problem;
    if (std::string problem = check_contacts(w, w.touching, true); !problem.empty()) return problem;
    return check_contacts(w, w.resting.records, false);
}

}  // namespace lendulet
