// How far two boxes are apart, or how deep they overlap, by the features that face each other along the best of their
// fifteen separating axes.
#pragma once

#include "collision/epa.h"

namespace lendulet {

// The cores are boxes. The answer is exact; a negative depth is the distance of boxes apart, whose nearest points then
// lie in the two features. In `simplex` the points to begin with next time are left: four where the boxes overlap,
// three of a face of the difference where they are apart. False where the boxes are apart by other features, or where
// edges or faces that decide are parallel, so that the points are many: GJK and EPA then find it. Apart, `simplex` is
// left with a point near the answer.
bool closest_of_boxes(const CoreDifference& difference, Simplex& simplex, Penetration& out);

}  // namespace lendulet
