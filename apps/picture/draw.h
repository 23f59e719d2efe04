// A small software renderer: perspective, depth buffer, one distant light with shadows. Enough for pictures in
// documents.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/picture/solids.h"
#include "lendulet/math.h"

namespace picture {

using lendulet::Vec3;

struct Camera {
    Vec3 eye, target;
    float tangent_half_fov = 0.36f;  // of the vertical field of view
};

struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  // rows from the top
};

// A triangle in the world with its colour (linear, 0 .. 1).
struct Painted {
    Triangle triangle;
    Vec3 colour;
};

Image draw(const std::vector<Painted>& triangles, const Camera& camera, int width, int height);

}  // namespace picture
