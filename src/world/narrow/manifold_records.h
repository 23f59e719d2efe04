// Manifolds into the records that the solver reads, and impulses from the step before into them.
#pragma once

#include "collision/batch/boxes.h"
#include "collision/manifold.h"
#include "world/world_data.h"

namespace lendulet {

// The parts of a record that stay while its pair lasts.
void prepare_record(const WorldData& world, const ColliderPair& p, ContactRecord& r);

// The surface of a record whose triangle is set, where triangles have materials of their own; else as prepared.
void set_surface(const WorldData& world, const ColliderPair& p, ContactRecord& r);

// The same after a material has changed.
void renew_surface(const WorldData& world, const ColliderPair& p, ContactRecord& r);

// All others but impulses and the index of the pair. `a` and `b` are the shapes' frames.
void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const Manifold& m);
void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const BatchManifold& m);

// Whether a manifold has one point, which is that of the record: its impulses are what they were.
inline bool is_same_point(const ContactRecord& r, int count, uint32_t id) {
    return r.point_count == 1 && count == 1 && r.id[0] == id;
}
inline bool is_same_point(const ContactRecord& r, const Manifold& m) {
    return is_same_point(r, m.count, m.points[0].id);
}
inline bool is_same_point(const ContactRecord& r, const BatchManifold& m) { return is_same_point(r, m.count, m.id[0]); }

// What is left of a record while its manifold is replaced.
struct OldContact {
    explicit OldContact(const ContactRecord& r);
    float normal_impulse[4], friction_impulse[3], twist_impulse;
    ContactPointRecord points[4];
    uint32_t id[4], key;
    int32_t point_count;
};
// Impulses of the points that were there in the step before, times `scale`: the same are those with one name, or else
// the nearest within a part of the smaller shape's radius.
void warm_start(ContactRecord& r, const OldContact& old, const ShapeFrame& a, const ShapeFrame& b, float scale);
void clear_impulses(ContactRecord& r);
void scale_impulses(ContactRecord& r, float scale);

}  // namespace lendulet
