// The broad-phase structures. To add one: its class and header here, its enumerator in lendulet/options.h, its case in
// broad_phase.cpp, its name in names.cpp.
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
#include "lendulet/options.h"

namespace lendulet {

using BroadPhaseStructure = std::variant<AllPairs, Sweep1, Sweep3, TwoTrees<RTree>, RtreeOmt, WideTree>;

inline constexpr int broad_phase_types = static_cast<int>(BroadPhaseType::wide_tree) + 1;

}  // namespace lendulet
