// The list of broad-phase structures, in the order of BroadPhaseType. To add one: its class and header here, its
// enumerator in lendulet/options.h, its name in names.cpp.
//
// A structure has, besides what BroadPhase has under the same name (set_fixed, set_moving, find_pairs, update, boxes,
// bytes, check and, where it has a use for it, move_all):
//   template <class Visit> void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
//       visit(index) for every box of both sets that overlaps, each once
//   void cast(BoxCast& cast) const;           offers every box of both sets that could better the best hit
//   void nearest(NearestBox& nearest) const;  likewise
#pragma once

#include <variant>

#include "broad_phase/all_pairs.h"
#include "broad_phase/rtree/two_trees.h"
#include "broad_phase/sweep/sweep_1.h"
#include "broad_phase/sweep/sweep_3.h"
#include "broad_phase/wide_tree/wide_tree.h"

namespace lendulet {

using BroadPhaseStructure =
    std::variant<AllPairs, Sweep1, Sweep3, RtreeQuadratic, RtreeStar, RtreeStr, RtreeOmt, WideTree>;

}  // namespace lendulet
