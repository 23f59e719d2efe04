// The feasible motion that is nearest to a wanted one: the projection onto what a few planes leave, exactly.
#pragma once

#include <span>

#include "lendulet/math.h"

namespace lendulet {

// The motion d keeps it where dot(normal, d) >= least.
struct MotionBound {
    Vec3 normal;
    float least;
    bool moves;          // the bound of something that moves, which yields to what does not
    float speed = 0.0f;  // of that thing along the normal, m/s
};

struct NearestMotion {
    Vec3 motion;
    bool possible;  // false: no motion keeps all bounds, and those that move were left out, or all
};
NearestMotion nearest_motion(Vec3 wanted, std::span<const MotionBound> bounds);

}  // namespace lendulet
