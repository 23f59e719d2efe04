// How far two boxes are apart, or how deep they overlap, by the faces of their difference.
#pragma once

#include "collision/box_difference.h"

namespace lendulet {

// Begins with the face in the cache, where it is known. Ends early like distance(). Leaves a face in the cache, and in
// an empty one a point of it. False, with the cache as it was, where the boxes overlap or nearly so and edges or faces
// are parallel, so that there are many nearest points, or where rounding leaves an answer unproven: GJK and EPA then
// find it.
bool closest_of_boxes(const BoxDifference& boxes, float max_distance, GjkCache& cache, ConvexDistance& out);

}  // namespace lendulet
