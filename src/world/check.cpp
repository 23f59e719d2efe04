// Verifies that the parts of a world agree with each other; tests run it between steps.
#include "world/world_data.h"

namespace lendulet {

std::string World::check() const {
    const WorldData& w = *data_;
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
    for (size_t i = 1; i < w.pairs.now.size(); ++i) {
        const ColliderPair &p = w.pairs.now[i - 1], &q = w.pairs.now[i];
        if (p.a > q.a || (p.a == q.a && p.b >= q.b)) return "the pair list is not sorted";
    }
    for (uint32_t i : w.touching) {
        if (i >= w.records.size()) return "a touching record is out of range";
        const ContactRecord& r = w.records[i];
        if (r.point_count < 1 || r.point_count > 4) return "a manifold has an impossible number of points";
        float n = r.normal[0] * r.normal[0] + r.normal[1] * r.normal[1] + r.normal[2] * r.normal[2];
        if (!(n > 0.999f && n < 1.001f)) return "a contact normal is not a unit vector";
        for (int j = 0; j < r.point_count; ++j)
            if (!(r.normal_impulse[j] >= 0.0f)) return "a contact pulls";
    }
    return {};
}

}  // namespace lendulet
