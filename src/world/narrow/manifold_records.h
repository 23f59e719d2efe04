// Manifolds into the records that the solver reads, and impulses from the step before into them.
#pragma once

#include "collision/batch/boxes.h"
#include "collision/manifold.h"
#include "world/world_data.h"

namespace lendulet {

// What all manifolds of a pair share.
struct ContactBase {
    ContactSurface surface;
    Vec3 arm_a;    // of A's shape
    Vec3 centres;  // from A's centre of mass to B's
    float separation_speed;
    float same_point;  // two points this close are the same from step to step, m
    uint32_t flags, pair;
};
ContactBase contact_base(const WorldData& world, const ColliderPair& p, uint32_t index);

// Without impulses.
void fill_record(ContactRecord& r, const ContactBase& base, const Manifold& m);
void fill_record(ContactRecord& r, const ContactBase& base, const BoxManifold& m);

// Impulses of the points that were there in the step before, times `scale`: the same are those with one name, or else
// the nearest within `tolerance`.
void warm_start(ContactRecord& r, const ContactRecord& old, float tolerance, float scale);
void scale_impulses(ContactRecord& r, float scale);

}  // namespace lendulet
