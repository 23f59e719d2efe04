// Sizes of convex shapes in their own frame, as far as a character needs them.
#pragma once

#include "lendulet/shapes.h"

namespace lendulet {

struct Outline {
    float lowest = 0.0f;  // y of the lowest point
    float width = 0.0f;   // the least half extent across y
    float across = 0.0f;  // the farthest from the y axis
    float reach = 0.0f;   // of a ball about the origin that holds the shape
};
// Only of shapes that a body accepts and that are convex.
Outline outline_of(const Shape& shape);
// The shape with a ball of radius `by` swept around it.
Shape grown(const Shape& shape, float by);

}  // namespace lendulet
