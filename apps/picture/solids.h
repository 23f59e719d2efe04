// Triangles of shapes, for pictures only.
#pragma once

#include <vector>

#include "lendulet/shapes.h"

namespace picture {

struct Triangle {
    lendulet::Vec3 corners[3];
    lendulet::Vec3 normals[3];  // unit, outward, one per corner: equal on flat faces
};

// The surface of a shape in its local frame. Curved surfaces are cut finely enough for a picture; sharp shapes are
// drawn without their rounding. Planes become a large square; meshes and height fields give nothing.
std::vector<Triangle> triangles_of(const lendulet::Shape& shape);

}  // namespace picture
