// The triangles near a convex shape, kept from step to step: found for a wider box than the shape's, they hold as long
// as the shape stays within that. Each has a number of metres that shape and surface must move relative to each other
// before a test that it failed can come out otherwise; until then it is not read. What is kept decides nothing but the
// time.
#pragma once

#include <cstdint>

#include "geometry/triangle_surface.h"

namespace lendulet {

struct alignas(64) MeshCandidates {
    static constexpr int capacity = 192;
    struct Entry {
        uint32_t index;
        float apart;  // what must be spent before the triangle can matter
    };

    Vec3 lower, upper;   // the wider box, mesh frame
    int32_t count = -1;  // -1: not looked for; more than the capacity: they are not listed
    // How the shape lay when they were looked through last, mesh frame, and the margin of that.
    Vec3 position;
    Quat turn;
    float margin;
    // How far any point of the shape may have come towards any triangle since they were found, step by step, m.
    float spent;
    Entry listed[capacity];  // in the order of the surface; without initial values

    MeshCandidates() {}

    bool hold(Vec3 box_lower, Vec3 box_upper) const {
        return count >= 0 && lower.x <= box_lower.x && lower.y <= box_lower.y && lower.z <= box_lower.z &&
               upper.x >= box_upper.x && upper.y >= box_upper.y && upper.z >= box_upper.z;
    }
    bool are_listed() const { return count <= capacity; }

    // The shape's box, margin included. Of those that were listed what is known stays, and others may matter.
    void find(const TriangleSurface& surface, Vec3 box_lower, Vec3 box_upper, float leeway);

    // A shape of which no point is farther than `reach` from its position.
    struct Placing {
        Vec3 position;
        Quat turn;
        float margin, reach;
    };
    // To be told of every place at which they are looked through.
    void stand(const Placing& now) { position = now.position, turn = now.turn, margin = now.margin; }
    void move(const Placing& now, float slack);

    // Those that may matter, by their places on the list; their number.
    int near(uint32_t (&triangles)[capacity], uint8_t (&places)[capacity]) const {
        int found = 0;
        for (int i = 0; i < count; ++i) {
            triangles[found] = listed[i].index, places[found] = static_cast<uint8_t>(i);
            found += listed[i].apart <= spent;
        }
        return found;
    }
    // What was found of one of them: what it is away from mattering, or less.
    void set_apart(int place, float away) { listed[place].apart = spent + away; }
};
static_assert(sizeof(MeshCandidates) == 1600);

}  // namespace lendulet
