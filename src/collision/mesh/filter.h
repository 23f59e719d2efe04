// Which of the mesh triangles near a convex shape are worth looking at, four at a time: tests of separation along the
// triangle's normal, its three sides and the shape's own axes. What it rejects touches nothing, or touches the
// neighbour instead, so that what it lets through decides nothing but the time.
#pragma once

#include <cstdint>

#include "geometry/geometry.h"
#include "geometry/triangle_surface.h"

namespace lendulet {

class MeshFilter {
public:
    static constexpr int lanes = 4;

    // The shape at `position` with `turn` from its axes to those of the mesh; [lower, upper] its bounds, margin
    // included, and `centre` its centre, both relative to its position, mesh axes. Cores farther than `limit` from a
    // triangle do not matter, give or take `slack`.
    MeshFilter(const TriangleSurface& surface, const Geometry& shape, Quat turn, Vec3 position, Vec3 lower, Vec3 upper,
               Vec3 centre, float limit, float slack);

    // Masks: bit i is that of triangle i.
    struct Result {
        uint32_t live = 0;   // it may touch, or the shape is beyond its plane
        uint32_t apart = 0;  // the core is farther than the limit from it, though it crosses its plane
        uint32_t behind;     // the shape's centre is
        uint32_t beside;     // all of the core is outside one of its sides
        // Where the core's lowest point along its normal is, of shapes of which that is found on the way.
        bool has_lowest;
        uint32_t beyond[3];          // see beyond_edges()
        float x[lanes], y[lanes], z[lanes];  // relative to the shape's position, the shape's axes
        uint8_t edges_beyond(int i) const {
            return static_cast<uint8_t>((beyond[0] >> i & 1) | (beyond[1] >> i & 1) << 1 | (beyond[2] >> i & 1) << 2);
        }
    };
    // `count` triangles, 1 to 4. Where none is live the rest of the result is unset.
    void test(const uint32_t* triangles, int count, Result& out) const;

private:
    const TriangleSurface& surface_;
    const Geometry& shape_;
    Mat3 to_shape_;                  // rows: the shape's axes in those of the mesh
    Vec3 position_, lower_, upper_;  // mesh frame
    Vec3 centre_;                    // relative to the position, mesh axes
    Vec3 box_lower_, box_upper_;     // of the core and the limit, the shape's axes
    float limit_, slack_;
};

}  // namespace lendulet
