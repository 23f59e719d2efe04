// Shapes in words, as command lines and the address of the viewer's page have them.
#pragma once

#include <string>

#include "lendulet/result.h"
#include "lendulet/shapes.h"

namespace lendulet::explain {

struct Placed {
    Shape shape;
    Transform place;
};

// "box:0.5,0.4,0.3" or with a place and a turn (axis times angle in degrees): "box:0.5,0.4,0.3@1.2,0.1,0@0,0,30". There
// are box:X,Y,Z (half extents), sphere:R, capsule:H,R, cylinder:H,R, cone:H,R, tapered-capsule:H,R,R and hull:N,R (N
// points on a ball). Error bad_query with a sentence.
Result<Placed> read_shape(const std::string& text);

}  // namespace lendulet::explain
