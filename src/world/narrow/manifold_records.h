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

// All others but impulses and the index of the pair. `a` and `b` are the shapes' frames.
void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const Manifold& m);
void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const BoxManifold& m);

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
