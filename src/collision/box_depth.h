// How deep two boxes overlap, exactly, by their fifteen separating axes.
#pragma once

#include "collision/epa.h"

namespace lendulet {

// The cores are boxes. False where they are apart, or where edges or faces that decide the depth are parallel, so that
// the points that belong to it are many: GJK and EPA then find it. In `simplex` four points are left to begin with.
bool depth_of_boxes(const CoreDifference& difference, Simplex& simplex, Penetration& out);

}  // namespace lendulet
