// The triangles near a convex shape, kept from step to step: found for a wider box than the shape's, they hold as long
// as the shape stays within that. What is kept decides nothing but the time.
#pragma once

#include <cstdint>

#include "geometry/triangle_surface.h"

namespace lendulet {

struct alignas(64) MeshCandidates {
    static constexpr int capacity = 64;

    Vec3 lower, upper;   // the wider box, mesh frame
    int32_t count = -1;  // -1: not looked for; more than the capacity: they are not listed
    uint32_t unused;
    uint32_t index[capacity];  // in the order of the surface
    // The triangles' own boxes in steps of 1/255 of the wider one, grown by a step or two.
    uint8_t low[3][capacity], high[3][capacity];

    bool hold(Vec3 box_lower, Vec3 box_upper) const {
        return count >= 0 && lower.x <= box_lower.x && lower.y <= box_lower.y && lower.z <= box_lower.z &&
               upper.x >= box_upper.x && upper.y >= box_upper.y && upper.z >= box_upper.z;
    }
    bool are_listed() const { return count <= capacity; }

    void find(const TriangleSurface& surface, Vec3 box_lower, Vec3 box_upper, float leeway);
    // Those whose boxes may meet [box_lower, box_upper], which lies in the wider box; their number.
    int near(Vec3 box_lower, Vec3 box_upper, uint32_t (&out)[capacity]) const;

private:
    Vec3 steps_per_metre() const;
};
static_assert(sizeof(MeshCandidates) == 704);

}  // namespace lendulet
