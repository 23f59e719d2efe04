// Shapes as plain numbers, for everything that writes them down: the C interface, recordings.
#pragma once

#include "lendulet/shapes.h"

namespace lendulet {

struct PlainShape {
    int type;  // the shape's index among the alternatives of Shape
    // Sphere: radius; capsule, cylinder, cone: half height, radius; tapered ones: half height, bottom and top radius;
    // box: half extents; plane: normal, offset; hulls, meshes and height fields: nothing
    float size[4];
    float rounding;
};
PlainShape plain(const Shape& shape);

// What hulls, meshes and height fields with the same surface share; null for all others.
const void* surface_of(const Shape& shape);

}  // namespace lendulet
