// What the narrow phase produces: up to four contact points with one normal, between two convex pieces.
#pragma once

#include <cstdint>

#include "lendulet/math.h"

namespace lendulet {

struct ManifoldPoint {
    Vec3 position;     // half way between the two surfaces; world axes, relative to the position of shape A
    float separation;  // along the normal, m; negative = overlap
    uint32_t id;       // names the two features that meet; equal ids from step to step are the same point
};

// Names of the points that carried a load. Of many points these are rather chosen again.
struct CarriedPoints {
    uint32_t ids[4];
    int count = 0;
    bool has(uint32_t id) const {
        bool found = false;
        for (int i = 0; i < count; ++i) found = found || ids[i] == id;
        return found;
    }
};

struct Manifold {
    Vec3 normal;  // unit, world axes, from A to B
    int count = 0;
    ManifoldPoint points[4];
    // How the points move while the bodies turn and slide within a step. A point of a ball does not turn with it: only
    // the core point does. These are the sweep radii between core point and surface, for each side, along the normal.
    float radius_a = 0.0f, radius_b = 0.0f;
    // Which body the points ride on: 0 on A, 1 on B, 0.5 half way (two edges). A ball's point rides with the ball.
    float follow = 0.5f;
    int32_t triangle = -1;  // of a mesh or height field, as the user counts them, -1: none
    uint32_t key = 0;       // names the manifold among those of its pair (mesh triangles); 0 for convex pairs
};

}  // namespace lendulet
