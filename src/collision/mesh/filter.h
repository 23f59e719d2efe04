// Which of the mesh triangles near a convex shape are worth looking at, W at a time: tests of separation along the
// triangle's normal, its three sides and the shape's own axes. What it rejects touches nothing, or touches the
// neighbour instead, so that what it lets through decides nothing but the time.
#pragma once

#include <cstdint>

#include "geometry/triangle_surface.h"

namespace lendulet {

struct MeshQuery;

// Triangles side by side and what they are tested against; filled and read by MeshFilter. Of masks, bit i is that of
// triangle i.
struct MeshFilterBatch {
    static constexpr int capacity = 64, room = capacity + 16;  // whole blocks of the widest lanes
    int count;
    float corner[3][3][room], front[3][room];  // mesh frame; by corner and component, by component of the unit normal
    float lean[room];  // most that the direction of the shortest distance leans across a side, as sine

    const Geometry* shape;
    const Vec3* hull;  // its corners, where it is a hull of few
    int hull_count;
    Mat3 to_shape;                // rows: the shape's axes in those of the mesh
    Vec3 position, lower, upper;  // of the shape, and bounds relative to that, margin included, mesh axes
    Vec3 centre;                  // of the shape, relative to its position, mesh axes
    Vec3 box_centre, box_half;    // of the core, the shape's axes
    Vec3 box_lower, box_upper;    // of the core and the limit, the shape's axes
    float limit, slack;           // cores farther than that do not matter, give or take the slack, which is in it

    uint64_t live;    // out: it may touch, or the shape is beyond its plane
    uint64_t apart;   // out: the core is farther than the limit from it, though it crosses its plane
    uint64_t behind;  // out: the shape's centre is
    uint64_t beside;  // out: all of the core is outside one of its sides
    // Out: where the core's lowest point along its normal is, of shapes of which that is found on the way: edges as of
    // beyond_edges(), place relative to the shape's position, the shape's axes.
    bool has_lowest;
    uint64_t beyond[3];
    float lowest[3][room];
};

// Overlapping by h, the lowest point along a normal may be within a side by h tan(a / 2), with a the angle up to which
// edges are gentle.
inline constexpr float half_gentle_tangent = 0.125f;

using FilterTriangles = void (*)(MeshFilterBatch&);
// Four at a time.
void filter_triangles(MeshFilterBatch& batch);

class MeshFilter {
public:
    static constexpr int capacity = MeshFilterBatch::capacity;

    // `limit`: cores farther than that from a triangle do not matter.
    MeshFilter(const MeshQuery& q, float limit);

    // Up to `capacity` triangles.
    void test(const uint32_t* triangles, int count);

    uint64_t live() const { return batch_.live; }
    bool is_apart(int i) const { return (batch_.apart >> i & 1) != 0; }
    bool is_behind(int i) const { return (batch_.behind >> i & 1) != 0; }
    bool is_beside(int i) const { return (batch_.beside >> i & 1) != 0; }
    // Whether the two that follow are known.
    bool has_lowest() const { return batch_.has_lowest; }
    Vec3 lowest(int i) const { return {batch_.lowest[0][i], batch_.lowest[1][i], batch_.lowest[2][i]}; }
    uint8_t edges_beyond(int i) const {
        const uint64_t* b = batch_.beyond;
        return static_cast<uint8_t>((b[0] >> i & 1) | (b[1] >> i & 1) << 1 | (b[2] >> i & 1) << 2);
    }

private:
    void load(const uint32_t* triangles, int count);

    const TriangleSurface& surface_;
    FilterTriangles filter_;
    MeshFilterBatch batch_;
};

}  // namespace lendulet
