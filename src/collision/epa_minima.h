// The least depth where the expanding polytope is full before it has proven one: round differences have valleys, arcs
// of directions that are all nearly as good, along which a polytope of any reasonable size leaves several minima open.
#pragma once

#include "collision/epa.h"
#include "collision/epa_polytope.h"

namespace lendulet {

// The least of the minima that the faces of the polytope lead to. Faces whose distance shows that nothing below `known`
// (m; the depth of a minimum that the caller has, or very large) lies beyond them are left out; where that is all of
// them, the depth of the result is very large.
Penetration search_minima(const CoreDifference& difference, const Polytope& polytope, double known, int expansions);

}  // namespace lendulet
